#include "finish/cross_validation.h"

#include "base/parallel.h"
#include "finish/window_means.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace sparselens {

namespace {

constexpr std::size_t grain = 1 << 14; // cells that a thread takes at once

template <typename Task>
void for_cells(const ArrayGrid &grid, const Task &task) {
    parallel_ranges(grid.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) task(i);
    });
}

// What the renders say of a candidate, for each cell or square: means over its pixels.
struct Answers {
    Values confirmed; // by the render that did not make the change
    Values energy;    // of the change, plus the cost of its noise
    Values variance;  // of `confirmed` in one pixel, if the change were wrong
};

// The first change, the second, and that of both. Pixels count by their samples, or all alike.
std::array<Answers, 3> answers_of(const CellEvidence &evidence, const ArrayGrid &grid, bool alike) {
    std::array<Answers, 3> found;
    for (Answers &of : found)
        for (Values *values : {&of.confirmed, &of.energy, &of.variance}) values->assign(grid.size(), 0.0f);
    for_cells(grid, [&](std::size_t i) {
        const std::array<double, 2> samples{evidence.samples[0][i], evidence.samples[1][i]};
        const double all = samples[0] + samples[1], of_both = samples[0] * samples[1] / all;
        const double weight = alike ? 1 / all : 1;
        for (std::size_t k = 0; k < 2; ++k) {
            const double by = samples[1 - k] * weight;
            // Noise of the changed picture, as shown by the difference between the renders' pictures, costs more.
            const double part = of_both / samples[k];
            const auto add = [&](Answers &to, double its_part) {
                const double costs = its_part * FinishTuning::noise_costs;
                to.confirmed[i] +=
                    float(by * (double(evidence.confirmed[k][i]) - costs * double(evidence.shared[i])));
                to.energy[i] += float(by * (double(evidence.energy[k][i]) +
                                            (its_part - part + costs) * double(evidence.spread[i])));
                to.variance[i] += float(by * by * double(evidence.squares[k][i]) +
                                        by * weight * double(evidence.removed[k][i]) * evidence.event_height);
            };
            add(found[k], part);
            // The noise of the picture of both is that of two renders with half of all samples each.
            add(found[2], of_both * 2 / all);
        }
    });
    return found;
}

// How many entries of a grid lie within a square around one.
double entries_around(const ArrayGrid &grid, std::size_t i, int radius) {
    const auto along = [&](int at, int length) {
        return std::min(at + radius, length - 1) - std::max(at - radius, 0) + 1;
    };
    const Position at = grid.position(i);
    return double(along(at.column, grid.width())) * along(at.row, grid.height());
}

// Moves a share towards the one that fits a square of so many pixels best, as far as it is proven that they differ.
float proven(const Answers &square, std::size_t i, double pixels, double deviations, float share) {
    const double left = double(square.confirmed[i]) - double(share) * double(square.energy[i]);
    if (!(square.energy[i] > 0) || left == 0) return share;
    const double proof = 1 - deviations * deviations * double(square.variance[i]) / (pixels * left * left);
    return std::clamp(share + float(std::max(proof, 0.0) * left / double(square.energy[i])), 0.0f, 1.0f);
}

// Means over the square of this radius around each entry; of the whole grid without a radius.
Values means_around(Values values, const ArrayGrid &grid, std::optional<int> radius) {
    if (radius)
        box_mean(values, grid, *radius);
    else
        std::ranges::fill(values,
                          float(std::accumulate(values.begin(), values.end(), 0.0) / double(values.size())));
    return values;
}

// The share of each picture's change that is accepted, for each cell. If a cell has at least the mean samples of its
// square, evidence counts by its samples, so the noise of few samples hides nothing. If it has fewer, all evidence counts
// alike, so cells with many samples do not decide for it.
std::array<Values, 3> trusted(const CellEvidence &evidence, const Cells &cells) {
    const ArrayGrid &grid = cells.grid();
    const auto pixels = double(cells.side() * cells.side());
    Values samples = evidence.samples[0];
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += evidence.samples[1][i];
    const bool differ = std::ranges::any_of(samples, [&](float v) { return v != samples[0]; });
    std::vector<std::array<Answers, 3>> answers{answers_of(evidence, grid, false)}; // by samples, then alike
    if (differ) answers.push_back(answers_of(evidence, grid, true));
    std::array<Values, 3> shares;
    for (Values &of : shares) of.assign(grid.size(), 0.0f);
    const auto prove = [&](std::optional<int> radius, double deviations) {
        const Values around = means_around(samples, grid, radius);
        const int reach = radius.value_or(std::max(grid.width(), grid.height()));
        for (std::size_t k = 0; k < 3; ++k) {
            std::vector<Answers> here;
            for (const std::array<Answers, 3> &of : answers)
                here.push_back({means_around(of[k].confirmed, grid, radius),
                                means_around(of[k].energy, grid, radius),
                                means_around(of[k].variance, grid, radius)});
            for_cells(grid, [&](std::size_t i) {
                shares[k][i] = proven(here[differ && samples[i] < around[i]], i,
                                      pixels * entries_around(grid, i, reach), deviations, shares[k][i]);
            });
        }
    };
    prove({}, FinishTuning::proof_deviations);
    for (const int radius : FinishTuning::square_radii) prove(radius, FinishTuning::square_deviations);
    for (Values &of : shares) box_mean(of, grid, FinishTuning::trust_radius);
    return shares;
}

FOR_PROCESSORS void move_towards(float *__restrict picture, const float *__restrict candidate,
                                 const float *__restrict share, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) picture[i] += share[i] * (candidate[i] - picture[i]);
}

FOR_PROCESSORS void mean_of(const float *__restrict first, const float *__restrict second,
                            const float *__restrict of_first, float *__restrict mean, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) mean[i] = second[i] + of_first[i] * (first[i] - second[i]);
}

} // namespace

void blend_in(Trio &pictures, const Halves &candidate, const RayEvidence &evidence, Values &kept) {
    const Cells cells(evidence.grid, FinishTuning::trust_cell);
    const std::array<Values, 3> shares = trusted(evidence_of(pictures, candidate, evidence, cells), cells);
    const auto width = std::size_t(evidence.grid.width());
    parallel_for(std::size_t(evidence.grid.height()), [&](std::size_t y) {
        std::vector<float> share, both(width), of_first(width);
        for (std::size_t x = 0; x < width; ++x) {
            const auto [n, m] = evidence.samples.at(y * width + x);
            of_first[x] = n / (n + m);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            cells.interpolate(shares[k], y, share);
            for (std::size_t c = 0; c < pictures[k].size(); ++c) {
                const float *offered = k < 2 ? &candidate[k][c][y * width] : both.data();
                if (k == 2)
                    mean_of(&candidate[0][c][y * width], &candidate[1][c][y * width], of_first.data(),
                            both.data(), width);
                move_towards(&pictures[k][c][y * width], offered, share.data(), width);
            }
        }
        for (std::size_t x = 0; x < width; ++x) kept[y * width + x] *= 1 - share[x];
    });
}

namespace {

// The values of a run of pixels whose means over a cell are its CellEvidence.
struct RunEvidence {
    std::array<Run, 3> energy{};
    std::array<Run, 2> confirmed{}, squares{}, removed{};
    Run spread{}, shared{};
    Run light{}, variance{}; // of the light that the rays show above the picture
    std::array<Run, 2> samples{};
};

struct Pixels {
    std::array<const float *, 3> pictures;
    std::array<const float *, 2> candidate, rays;
};

// Approximately max(a, b).
inline float larger(float a, float b) { return b + positive(a - b); }

struct Tested {
    float energy, confirmed, removed;
};
[[gnu::always_inline]] inline Tested tested(float a, float b, float y, float exposure) {
    const float change = b - a, weighted = seen(exposure * larger(a, b)) * change;
    return {weighted * change, weighted * (y - a), weighted * weighted * positive(-change)};
}

FOR_PROCESSORS void add_channel(const Pixels &pixels, float exposure, RunEvidence *__restrict sums,
                                std::size_t count) {
    const float *a0 = pixels.pictures[0], *a1 = pixels.pictures[1], *a2 = pixels.pictures[2];
    const float *b0 = pixels.candidate[0], *b1 = pixels.candidate[1];
    const float *x = pixels.rays[0], *y = pixels.rays[1];
    for (std::size_t i = 0; i < count; ++i) {
        const Tested t0 = tested(a0[i], b0[i], y[i], exposure), t1 = tested(a1[i], b1[i], x[i], exposure);
        sums->energy[0][i] += t0.energy;
        sums->confirmed[0][i] += t0.confirmed;
        sums->removed[0][i] += t0.removed;
        sums->energy[1][i] += t1.energy;
        sums->confirmed[1][i] += t1.confirmed;
        sums->removed[1][i] += t1.removed;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float n = sums->samples[0][i], m = sums->samples[1][i], first = n / (n + m), second = 1 - first;
        const float b2 = first * b0[i] + second * b1[i], weight = seen(exposure * larger(a2[i], b2));
        const float apart = (b0[i] - a0[i]) - (b1[i] - a1[i]), difference = x[i] - y[i];
        sums->energy[2][i] += weight * (b2 - a2[i]) * (b2 - a2[i]);
        sums->spread[i] += weight * apart * apart;
        sums->shared[i] += weight * apart * (a0[i] - a1[i]);
        const float above = first * x[i] + second * y[i] - a2[i];
        sums->light[i] += positive(above);
        sums->variance[i] += first * m * difference * difference * (0.5f + std::copysign(0.5f, above));
    }
}

double sum_of(const Run &run) { return std::accumulate(run.begin(), run.end(), 0.0); }

// Each plane of cells with the run that is added to it.
template <typename Of>
void for_planes(CellEvidence &cells, RunEvidence &run, const Of &of) {
    for (std::size_t k = 0; k < 3; ++k) of(cells.energy[k], run.energy[k]);
    for (std::size_t k = 0; k < 2; ++k) {
        of(cells.confirmed[k], run.confirmed[k]);
        of(cells.squares[k], run.squares[k]);
        of(cells.removed[k], run.removed[k]);
        of(cells.samples[k], run.samples[k]);
    }
    of(cells.spread, run.spread);
    of(cells.shared, run.shared);
}

} // namespace

CellEvidence evidence_of(const Trio &pictures, const Halves &candidate, const RayEvidence &evidence,
                         const Cells &cells) {
    const auto width = std::size_t(cells.pixels().width());
    const auto pixels_at = [&](std::size_t c, std::size_t i) -> Pixels {
        return {{&pictures[0][c][i], &pictures[1][c][i], &pictures[2][c][i]},
                {&candidate[0][c][i], &candidate[1][c][i]},
                {&evidence.rays[0][c][i], &evidence.rays[1][c][i]}};
    };
    CellEvidence found;
    RunEvidence none;
    for_planes(found, none, [&](Values &plane, Run &) { plane.assign(cells.grid().size(), 0.0f); });
    struct Light {
        double sum = 0, variance = 0;
    };
    std::vector<Light> lights(std::size_t(cells.grid().height()));
    parallel_for(lights.size(), [&](std::size_t row) {
        const auto [begin, end] = cells.rows(row);
        for (std::size_t y = begin; y < end; ++y)
            for (std::size_t x = 0; x < width; x += run_length) {
                RunEvidence run;
                const std::size_t first = y * width + x, count = std::min(run_length, width - x);
                for (std::size_t i = 0; i < count; ++i)
                    for (std::size_t k = 0; k < 2; ++k) run.samples[k][i] = evidence.samples.at(first + i)[k];
                for (std::size_t c = 0; c < pictures[0].size(); ++c)
                    add_channel(pixels_at(c, first), evidence.exposure, &run, count);
                run.squares = run.confirmed;
                for (Run &squares : run.squares)
                    for (float &v : squares) v *= v;
                for_planes(found, run, [&](Values &plane, Run &values) {
                    cells.add(values, x, cells.of_row(plane, row));
                });
                lights[row].sum += sum_of(run.light);
                lights[row].variance += sum_of(run.variance);
            }
        for_planes(found, none, [&](Values &plane, Run &) { cells.divide(row, cells.of_row(plane, row)); });
    });
    Light light;
    for (const Light &of_row : lights) {
        light.sum += of_row.sum;
        light.variance += of_row.variance;
    }
    found.event_height = light.sum > 0 ? light.variance / light.sum : 0;
    return found;
}

} // namespace sparselens
