#include "finish/cross_validation.h"

#include "base/parallel.h"
#include "finish/window_means.h"

#include <cmath>
#include <numeric>

namespace sparselens {

namespace {

constexpr std::size_t grain = 1 << 14; // cells that a thread takes at once
constexpr float least_energy = 1e-9f;  // squared values: less than a picture shows
constexpr float largest_energy_ratio = 30, largest_confirmation = 50; // a logarithm; standard deviations

template <typename Task>
void for_cells(const ArrayGrid &grid, const Task &task) {
    parallel_ranges(grid.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) task(i);
    });
}

constexpr float area(int radius) { return float((2 * radius + 1) * (2 * radius + 1)); }
constexpr float outer = area(FinishTuning::ring_outer), inner = area(FinishTuning::ring_inner);

// Replaces values by their sums over the ring, which are approximate at the border of the picture.
void ring_sum(Values &values, const ArrayGrid &grid) {
    Values near = values;
    box_mean(values, grid, FinishTuning::ring_outer);
    box_mean(near, grid, FinishTuning::ring_inner);
    for_cells(grid, [&](std::size_t i) { values[i] = outer * values[i] - inner * near[i]; });
}

// The two measures that give a cell's class, for each picture: first a logarithm and standard deviations, then the
// places of these among the classes.
struct Measures {
    std::array<Values, 3> energy_ratio, confirmed;
};

std::size_t class_at(float place) { return std::min(std::size_t(place), classes_per_measure - 1); }

// Logarithms of energy over noise. `noise`: the squared difference of both renders.
std::array<Values, 3> energy_ratios(const CellEvidence &cells, Values noise, const ArrayGrid &grid) {
    ring_sum(noise, grid);
    std::array<Values, 3> ratios = cells.energy;
    for (std::size_t k = 0; k < 3; ++k) {
        soft_mean(ratios[k], grid, FinishTuning::energy_radius);
        for_cells(grid, [&](std::size_t i) {
            const double n = cells.samples[0][i], m = cells.samples[1][i];
            const std::array<double, 3> of_picture{n, m, n + m};
            const auto of_one = float(n * m / (n + m) / of_picture[k]) / (outer - inner);
            ratios[k][i] = std::log((std::max(ratios[k][i], 0.0f) + least_energy) /
                                    (std::max(noise[i], 0.0f) * of_one + least_energy));
        });
    }
    return ratios;
}

// The confirmed sum in the ring, in standard deviations of the rest that the tests leave: for each test, and for both
// together.
std::array<Values, 3> confirmations(const CellEvidence &cells, const ArrayGrid &grid) {
    std::array<Values, 2> sums = cells.confirmed, variances = cells.left;
    for (std::size_t k = 0; k < 2; ++k) {
        ring_sum(sums[k], grid);
        ring_sum(variances[k], grid);
    }
    const auto deviations = [](float sum, float variance) {
        return sum / std::sqrt(std::max(variance, 1e-30f));
    };
    std::array<Values, 3> found;
    for (Values &values : found) values.resize(grid.size());
    for_cells(grid, [&](std::size_t i) {
        const float n = cells.samples[0][i], m = cells.samples[1][i];
        for (std::size_t k = 0; k < 2; ++k) found[k][i] = deviations(sums[k][i], variances[k][i]);
        found[2][i] =
            deviations(m * sums[0][i] + n * sums[1][i], m * m * variances[0][i] + n * n * variances[1][i]);
    });
    return found;
}

// The share of each picture's change that is accepted, for each cell.
std::array<Values, 3> trusted(const CellEvidence &evidence, const Cells &cells, Among among) {
    const ArrayGrid &grid = cells.grid();
    Measures measures{energy_ratios(evidence, evidence.noise, grid), confirmations(evidence, grid)};
    Classes by_energy(classes_per_measure, -largest_energy_ratio, largest_energy_ratio),
        by_confirmation(classes_per_measure, -largest_confirmation, largest_confirmation);
    for (std::size_t i = 0; i < grid.size(); ++i)
        for (std::size_t k = 0; k < 2; ++k) {
            const double energy = double(evidence.energy[k][i]) * double(evidence.samples[1 - k][i]);
            by_energy.add(measures.energy_ratio[k][i], energy);
            by_confirmation.add(measures.confirmed[k][i], energy);
        }
    by_energy.divide();
    by_confirmation.divide();
    for (std::size_t k = 0; k < 3; ++k)
        for_cells(grid, [&](std::size_t i) {
            float &ratio = measures.energy_ratio[k][i], &confirmed = measures.confirmed[k][i];
            ratio = among == Among::classes ? by_energy.place_of(ratio) : 0;
            confirmed = among == Among::classes ? by_confirmation.place_of(confirmed) : 0;
        });

    const Tiles blocks(grid.box(), FinishTuning::block_px / FinishTuning::trust_cell);
    std::vector<ClassSums> of_one(blocks.count()), of_all(blocks.count());
    const auto pixels = double(cells.side() * cells.side());
    parallel_for(blocks.count(), [&](std::size_t b) {
        const PositionBox box = blocks.box(b);
        for (int y = box.min.row; y <= box.max.row; ++y)
            for (int x = box.min.column; x <= box.max.column; ++x) {
                const std::size_t i = grid.index(Position(x, y));
                const std::array<double, 2> samples{evidence.samples[0][i], evidence.samples[1][i]};
                const double all = samples[0] + samples[1], of_both = samples[0] * samples[1] / all;
                for (std::size_t k = 0; k < 2; ++k) {
                    const std::size_t cell = class_at(measures.energy_ratio[k][i]) * classes_per_measure +
                                             class_at(measures.confirmed[k][i]);
                    const double count = pixels * samples[1 - k];
                    // The part of a change that is noise, as shown by the difference between the renders' changes,
                    // costs more.
                    const double noise = double(evidence.spread[i]) * of_both / samples[k];
                    const auto add = [&](ClassSums &sums, double its_noise) {
                        sums.answers[cell] += count * double(evidence.confirmed[k][i]);
                        sums.energies[cell] += count * (double(evidence.energy[k][i]) + (its_noise - noise) +
                                                        its_noise * FinishTuning::noise_costs);
                        sums.unseen[cell] += count * double(evidence.removed[k][i]) * evidence.event_height;
                    };
                    add(of_one[b], noise);
                    // The noise of the picture of both is that of two renders with half of all samples each.
                    add(of_all[b], double(evidence.spread[i]) * of_both * 2 / all);
                }
            }
    });
    const Shares shares_of_one = shares_of(std::move(of_one)), shares_of_all = shares_of(std::move(of_all));

    std::array<Values, 3> share;
    for (std::size_t k = 0; k < 3; ++k) {
        const Shares &shares = k < 2 ? shares_of_one : shares_of_all;
        share[k].resize(grid.size());
        for_cells(grid, [&](std::size_t i) {
            share[k][i] = share_at(shares, measures.confirmed[k][i], measures.energy_ratio[k][i]);
        });
        box_mean(share[k], grid, FinishTuning::trust_radius);
    }
    return share;
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

void blend_in(Trio &pictures, const Halves &candidate, const RayEvidence &evidence, Values &kept,
              Among among) {
    const Cells cells(evidence.grid, FinishTuning::trust_cell);
    const std::array<Values, 3> shares =
        trusted(evidence_of(pictures, candidate, evidence, cells), cells, among);
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
    std::array<Run, 2> confirmed{}, left{}, removed{};
    Run spread{}, noise{};
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
    float energy, confirmed, left, removed;
};
[[gnu::always_inline]] inline Tested tested(float a, float b, float y) {
    const float change = b - a, weighted = seen(larger(a, b)) * change;
    return {weighted * change, weighted * (y - a), weighted * (y - b),
            weighted * weighted * positive(-change)};
}

FOR_PROCESSORS void add_channel(const Pixels &pixels, RunEvidence *__restrict sums, std::size_t count) {
    const float *a0 = pixels.pictures[0], *a1 = pixels.pictures[1], *a2 = pixels.pictures[2];
    const float *b0 = pixels.candidate[0], *b1 = pixels.candidate[1];
    const float *x = pixels.rays[0], *y = pixels.rays[1];
    for (std::size_t i = 0; i < count; ++i) {
        const Tested t0 = tested(a0[i], b0[i], y[i]), t1 = tested(a1[i], b1[i], x[i]);
        sums->energy[0][i] += t0.energy;
        sums->confirmed[0][i] += t0.confirmed;
        sums->left[0][i] += t0.left;
        sums->removed[0][i] += t0.removed;
        sums->energy[1][i] += t1.energy;
        sums->confirmed[1][i] += t1.confirmed;
        sums->left[1][i] += t1.left;
        sums->removed[1][i] += t1.removed;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float n = sums->samples[0][i], m = sums->samples[1][i], first = n / (n + m), second = 1 - first;
        const float b2 = first * b0[i] + second * b1[i], weight = seen(larger(a2[i], b2));
        const float apart = (b0[i] - a0[i]) - (b1[i] - a1[i]), difference = x[i] - y[i];
        sums->energy[2][i] += weight * (b2 - a2[i]) * (b2 - a2[i]);
        sums->spread[i] += weight * apart * apart;
        sums->noise[i] += seen(a2[i]) * difference * difference;
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
        of(cells.left[k], run.left[k]);
        of(cells.removed[k], run.removed[k]);
        of(cells.samples[k], run.samples[k]);
    }
    of(cells.spread, run.spread);
    of(cells.noise, run.noise);
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
                    add_channel(pixels_at(c, first), &run, count);
                for (Run &left : run.left)
                    for (float &v : left) v *= v;
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
