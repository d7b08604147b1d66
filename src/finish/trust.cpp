#include "finish/trust.h"

#include "base/for_processors.h"
#include "base/parallel.h"
#include "finish/classes.h"
#include "finish/window_means.h"

#include <cmath>

namespace sparselens {

namespace {

constexpr std::size_t grain = 1 << 14; // cells that a thread takes at once
constexpr float least_energy = 1e-9f;  // squared values: less than a picture shows
constexpr float largest_energy_ratio = 30, largest_confirmation = 50; // a logarithm; standard deviations

template <typename Task>
void for_cells(const Grid &grid, const Task &task) {
    parallel_ranges(grid.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) task(i);
    });
}

constexpr float area(int radius) { return float((2 * radius + 1) * (2 * radius + 1)); }
constexpr float outer = area(FinishTuning::ring_outer), inner = area(FinishTuning::ring_inner);

// Replaces values by their sums over the ring, which are approximate at the border of the picture.
void ring_sum(Values &values, const Grid &grid) {
    Values near = values;
    box_mean(values, grid, FinishTuning::ring_outer);
    box_mean(near, grid, FinishTuning::ring_inner);
    for_cells(grid, [&](std::size_t i) { values[i] = outer * values[i] - inner * near[i]; });
}

// The two measures that give a cell's class, for each picture: a logarithm and standard deviations, later places among
// classes.
struct Measures {
    std::array<Values, 3> energy_ratio, confirmed;
};

std::size_t class_at(float place) { return std::min(std::size_t(place), trust_classes - 1); }

// Logarithms of energy over noise. `noise`: the squared difference of both renders.
std::array<Values, 3> energy_ratios(const CellEvidence &cells, Values noise, const Grid &grid,
                                    const std::array<double, 2> &samples) {
    const auto [n, m] = samples;
    const std::array<double, 3> of_picture{n, m, n + m};
    ring_sum(noise, grid);
    std::array<Values, 3> ratios = cells.energy;
    for (std::size_t k = 0; k < 3; ++k) {
        soft_mean(ratios[k], grid, FinishTuning::energy_radius);
        const auto of_one = float(n * m / (n + m) / of_picture[k]) / (outer - inner);
        for_cells(grid, [&](std::size_t i) {
            ratios[k][i] = std::log((std::max(ratios[k][i], 0.0f) + least_energy) /
                                    (std::max(noise[i], 0.0f) * of_one + least_energy));
        });
    }
    return ratios;
}

// The confirmed sum in the ring, in standard deviations of the rest that the tests leave: for each test, and for both
// together.
std::array<Values, 3> confirmations(const CellEvidence &cells, const Grid &grid,
                                    const std::array<double, 2> &samples) {
    std::array<Values, 2> sums = cells.confirmed, variances = cells.left;
    for (std::size_t k = 0; k < 2; ++k) {
        ring_sum(sums[k], grid);
        ring_sum(variances[k], grid);
    }
    const auto deviations = [](float sum, float variance) {
        return sum / std::sqrt(std::max(variance, 1e-30f));
    };
    const auto n = float(samples[0]), m = float(samples[1]);
    std::array<Values, 3> found;
    for (Values &values : found) values.resize(grid.size());
    for_cells(grid, [&](std::size_t i) {
        for (std::size_t k = 0; k < 2; ++k) found[k][i] = deviations(sums[k][i], variances[k][i]);
        found[2][i] =
            deviations(m * sums[0][i] + n * sums[1][i], m * m * variances[0][i] + n * n * variances[1][i]);
    });
    return found;
}

// The share of each picture's change that is believed, for each cell.
std::array<Values, 3> trusted(const CellEvidence &evidence, const Cells &cells,
                              const std::array<double, 2> &samples) {
    const Grid &grid = cells.grid();
    Measures measures{energy_ratios(evidence, evidence.noise, grid, samples),
                      confirmations(evidence, grid, samples)};
    Classes by_energy(trust_classes, -largest_energy_ratio, largest_energy_ratio),
        by_confirmation(trust_classes, -largest_confirmation, largest_confirmation);
    const std::array testing{samples[1], samples[0]};
    for (std::size_t i = 0; i < grid.size(); ++i)
        for (std::size_t k = 0; k < 2; ++k) {
            const double energy = double(evidence.energy[k][i]) * testing[k];
            by_energy.add(measures.energy_ratio[k][i], energy);
            by_confirmation.add(measures.confirmed[k][i], energy);
        }
    by_energy.divide();
    by_confirmation.divide();
    for (std::size_t k = 0; k < 3; ++k)
        for_cells(grid, [&](std::size_t i) {
            float &ratio = measures.energy_ratio[k][i], &confirmed = measures.confirmed[k][i];
            ratio = by_energy.place_of(ratio);
            confirmed = by_confirmation.place_of(confirmed);
        });

    const Tiles blocks(grid.box(), FinishTuning::block_px / FinishTuning::trust_cell);
    std::vector<ClassSums> sums(blocks.count());
    const auto pixels = double(cells.side() * cells.side());
    const double of_both = samples[0] * samples[1] / (samples[0] + samples[1]);
    parallel_for(blocks.count(), [&](std::size_t b) {
        const Imath::Box2i box = blocks.box(b);
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                const std::size_t i = grid.index(x, y);
                for (std::size_t k = 0; k < 2; ++k) {
                    const std::size_t cell = class_at(measures.energy_ratio[k][i]) * trust_classes +
                                             class_at(measures.confirmed[k][i]);
                    const double count = pixels * testing[k];
                    // The part of a change that is noise, as shown by the difference between the renders' changes,
                    // costs more.
                    const double noise = double(evidence.spread[i]) * of_both / samples[k];
                    sums[b].answers[cell] += count * double(evidence.confirmed[k][i]);
                    sums[b].energies[cell] +=
                        count * (double(evidence.energy[k][i]) + noise * FinishTuning::noise_costs);
                    sums[b].unseen[cell] += count * double(evidence.removed[k][i]) * evidence.event_height;
                }
            }
    });
    const Shares shares = shares_of(std::move(sums));

    std::array<Values, 3> share;
    for (std::size_t k = 0; k < 3; ++k) {
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

FOR_PROCESSORS void mean_of(const float *__restrict first, const float *__restrict second, float of_first,
                            float *__restrict mean, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) mean[i] = second[i] + of_first * (first[i] - second[i]);
}

} // namespace

void blend_in(Trio &pictures, const Halves &candidate, const RayEvidence &evidence, Values &kept) {
    const Cells cells(evidence.grid, FinishTuning::trust_cell);
    const std::array<Values, 3> shares =
        trusted(evidence_of(pictures, candidate, evidence, cells), cells, evidence.samples);
    const auto width = std::size_t(evidence.grid.width());
    const auto of_first = float(evidence.samples[0] / (evidence.samples[0] + evidence.samples[1]));
    parallel_for(std::size_t(evidence.grid.height()), [&](std::size_t y) {
        std::vector<float> share, both(width);
        for (std::size_t k = 0; k < 3; ++k) {
            cells.interpolate(shares[k], y, share);
            for (std::size_t c = 0; c < pictures[k].size(); ++c) {
                const float *offered = k < 2 ? &candidate[k][c][y * width] : both.data();
                if (k == 2)
                    mean_of(&candidate[0][c][y * width], &candidate[1][c][y * width], of_first, both.data(),
                            width);
                move_towards(&pictures[k][c][y * width], offered, share.data(), width);
            }
        }
        for (std::size_t x = 0; x < width; ++x) kept[y * width + x] *= 1 - share[x];
    });
}

} // namespace sparselens
