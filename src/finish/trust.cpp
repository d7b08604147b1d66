#include "finish/trust.h"

#include "base/parallel.h"
#include "finish/classes.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

#include <cmath>

namespace sparselens {

namespace {

constexpr std::size_t classes = FinishTuning::classes, cells = classes * classes;
constexpr std::size_t grain = 1 << 14; // pixels that a thread takes at once
constexpr float least_energy = 1e-9f;  // squared values: below what a picture shows
constexpr float largest_energy_ratio = 30, largest_confirmation = 50; // a logarithm; standard deviations

template <typename Task>
void for_pixels(const Grid &grid, const Task &task) {
    parallel_ranges(grid.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) task(i);
    });
}

// A candidate beside the pictures that it may improve.
struct Offer {
    const Trio &pictures;
    const Halves &candidate;
    const RayEvidence &evidence;

    std::size_t channels() const { return pictures[0].size(); }
    float offered(std::size_t k, std::size_t c, std::size_t i) const {
        return k < 2 ? candidate[k][c][i] : of_both(evidence.samples, candidate[0][c][i], candidate[1][c][i]);
    }
    float change(std::size_t k, std::size_t c, std::size_t i) const {
        return offered(k, c, i) - pictures[k][c][i];
    }
    float weight(std::size_t k, std::size_t c, std::size_t i) const {
        return seen(std::max(offered(k, c, i), pictures[k][c][i]));
    }
    // How many samples a pixel the render has that tests k.
    double testing(std::size_t k) const { return evidence.samples[1 - k]; }
};

Values energy_of(const Offer &offer, std::size_t k) {
    Values energy(offer.evidence.grid.size());
    for_pixels(offer.evidence.grid, [&](std::size_t i) {
        float sum = 0;
        for (std::size_t c = 0; c < offer.channels(); ++c) {
            const float change = offer.change(k, c, i);
            sum += offer.weight(k, c, i) * change * change;
        }
        energy[i] = sum;
    });
    return energy;
}

// How the other render answers a change: the share of it that it confirms, and what it leaves.
struct Answer {
    float confirmed = 0, left = 0;
};
Answer answer(const Offer &offer, std::size_t k, std::size_t i) {
    Answer sum;
    for (std::size_t c = 0; c < offer.channels(); ++c) {
        const float weighted = offer.weight(k, c, i) * offer.change(k, c, i);
        const float y = offer.evidence.rays[1 - k][c][i];
        sum.confirmed += weighted * (y - offer.pictures[k][c][i]);
        sum.left += weighted * (y - offer.offered(k, c, i));
    }
    const auto testing = float(offer.testing(k));
    return {testing * sum.confirmed, testing * sum.left};
}

// The mean over the ring, of values that a box_mean() of each square has averaged; nearly, at the border of the picture.
void ring_mean(Values &values, const Grid &grid) {
    constexpr auto area = [](int radius) { return float((2 * radius + 1) * (2 * radius + 1)); };
    constexpr float outer = area(FinishTuning::ring_outer), inner = area(FinishTuning::ring_inner);
    Values near = values;
    box_mean(values, grid, FinishTuning::ring_outer);
    box_mean(near, grid, FinishTuning::ring_inner);
    for_pixels(grid,
               [&](std::size_t i) { values[i] = (outer * values[i] - inner * near[i]) / (outer - inner); });
}

// The noise of one sample a pixel, as the two renders differ around each pixel.
Values noise_around(const Offer &offer) {
    const RayEvidence &evidence = offer.evidence;
    const auto [n, m] = evidence.samples;
    const auto of_one = float(n * m / (n + m));
    Values noise(evidence.grid.size());
    for_pixels(evidence.grid, [&](std::size_t i) {
        float sum = 0;
        for (std::size_t c = 0; c < offer.channels(); ++c) {
            const float difference = evidence.rays[0][c][i] - evidence.rays[1][c][i];
            sum += seen(offer.pictures[2][c][i]) * difference * difference;
        }
        noise[i] = of_one * sum;
    });
    ring_mean(noise, evidence.grid);
    return noise;
}

// Sums over the ring: what the tests confirm, and their spread. Of each test alone, and of both together.
struct Confirmation {
    Values sum, variance;
    float deviations(std::size_t i) const { return sum[i] / std::sqrt(std::max(variance[i], 1e-30f)); }
};
Confirmation confirmation(const Offer &offer, std::size_t k) {
    const Grid &grid = offer.evidence.grid;
    Confirmation found{Values(grid.size()), Values(grid.size())};
    for_pixels(grid, [&](std::size_t i) {
        const auto [confirmed, left] = answer(offer, k, i);
        found.sum[i] = confirmed;
        found.variance[i] = left * left;
    });
    ring_mean(found.sum, grid);
    ring_mean(found.variance, grid);
    constexpr int outer = 2 * FinishTuning::ring_outer + 1, inner = 2 * FinishTuning::ring_inner + 1;
    constexpr auto pixels = float(outer * outer - inner * inner);
    for_pixels(grid, [&](std::size_t i) {
        found.sum[i] *= pixels;
        found.variance[i] *= pixels;
    });
    return found;
}

// Sums over the pixels of each class, one for each block of the picture.
struct ClassSums {
    std::vector<std::array<double, cells>> answers, energies, unseen;
};

using Table = std::array<double, cells>;

// Neighbours in the table are alike, so each class borrows from them.
void soften(Table &table) {
    constexpr double side = 0.21, middle = 1 - 2 * side; // a Gaussian of 0.7 classes
    const auto along = [&](std::size_t step, std::size_t other) {
        for (std::size_t line = 0; line < classes; ++line) {
            std::array<double, classes> values;
            for (std::size_t i = 0; i < classes; ++i) values[i] = table[line * other + i * step];
            for (std::size_t i = 0; i < classes; ++i)
                table[line * other + i * step] =
                    side * (values[i == 0 ? 0 : i - 1] + values[std::min(i + 1, classes - 1)]) +
                    middle * values[i];
        }
    };
    along(1, classes);
    along(classes, 1);
}

Table shares_of(ClassSums &sums) {
    Table answers{}, energies{}, variance{};
    for (std::size_t b = 0; b < sums.answers.size(); ++b) {
        soften(sums.answers[b]);
        soften(sums.energies[b]);
        soften(sums.unseen[b]);
        for (std::size_t i = 0; i < cells; ++i) {
            answers[i] += sums.answers[b][i];
            energies[i] += sums.energies[b][i];
            variance[i] += sums.unseen[b][i];
        }
    }
    Table shares{};
    for (std::size_t i = 0; i < cells; ++i) {
        if (!(answers[i] > 0) || !(energies[i] > 0)) continue;
        const double share = answers[i] / energies[i];
        for (std::size_t b = 0; b < sums.answers.size(); ++b) {
            const double left = sums.answers[b][i] - share * sums.energies[b][i];
            variance[i] += left * left;
        }
        shares[i] = std::min(share, 1.0) * std::max(1 - variance[i] / (answers[i] * answers[i]), 0.0);
    }
    return shares;
}

// Between the middles of classes, linear.
float share_at(const Table &shares, double across, double down) {
    const auto split = [](double place) {
        const double from_middle = std::clamp(place - 0.5, 0.0, double(classes - 1));
        const auto k = std::min(std::size_t(from_middle), classes - 2);
        return std::pair(k, from_middle - double(k));
    };
    const auto [i, x] = split(across);
    const auto [j, y] = split(down);
    const auto at = [&](std::size_t row, std::size_t column) { return shares[row * classes + column]; };
    return float((1 - y) * ((1 - x) * at(j, i) + x * at(j, i + 1)) +
                 y * ((1 - x) * at(j + 1, i) + x * at(j + 1, i + 1)));
}

// How much light a bright event brings to one sample: its variance over its mean, as events of S. Poisson have it, of all light
// that the rays show above the picture. What both renders show alike is no event, and adds to the mean alone.
double event_height(const Offer &offer) {
    const auto [n, m] = offer.evidence.samples;
    const Halves &rays = offer.evidence.rays;
    double light = 0, variance = 0;
    for (std::size_t c = 0; c < offer.channels(); ++c)
        for (std::size_t i = 0; i < offer.evidence.grid.size(); ++i) {
            const double above = double(of_both(offer.evidence.samples, rays[0][c][i], rays[1][c][i]) -
                                        offer.pictures[2][c][i]);
            if (!(above > 0)) continue;
            const double difference = double(rays[0][c][i] - rays[1][c][i]);
            light += above;
            variance += n * m / (n + m) * difference * difference;
        }
    return light > 0 ? variance / light : 0;
}

// Where a candidate is darker, the light that it takes away may come from events so rare that no ray met one. The variance that
// such light would have (S. Poisson) is that of the answer, too.
double unseen_variance(const Offer &offer, std::size_t k, std::size_t i, double height) {
    double sum = 0;
    for (std::size_t c = 0; c < offer.channels(); ++c) {
        const double change = double(offer.change(k, c, i)),
                     weighted = double(offer.weight(k, c, i)) * change;
        sum += weighted * weighted * std::max(-change, 0.0);
    }
    return sum * height * offer.testing(k);
}

// The part of a change that is noise, as the changes of both renders differ.
double noise_of_change(const Offer &offer, std::size_t k, std::size_t i) {
    const auto [n, m] = offer.evidence.samples;
    double sum = 0;
    for (std::size_t c = 0; c < offer.channels(); ++c) {
        const double difference = double(offer.change(0, c, i)) - double(offer.change(1, c, i));
        sum += double(offer.weight(2, c, i)) * difference * difference;
    }
    return sum * n * m / (n + m) / offer.evidence.samples[k] * offer.testing(k);
}

// The two measures that make a pixel's class, of each picture.
struct Measures {
    std::array<Values, 3> energy_ratio, confirmed; // a logarithm; standard deviations
};

Measures measured(const Offer &offer, std::array<Values, 2> &energies) {
    const RayEvidence &evidence = offer.evidence;
    const Grid &grid = evidence.grid;
    const Values noise = noise_around(offer);
    const std::array samples{evidence.samples[0], evidence.samples[1],
                             evidence.samples[0] + evidence.samples[1]};
    Measures measures;
    for (std::size_t k = 0; k < 3; ++k) {
        Values energy = energy_of(offer, k);
        if (k < 2) energies[k] = energy;
        soft_mean(energy, grid, FinishTuning::energy_radius);
        for_pixels(grid, [&](std::size_t i) {
            energy[i] = std::log((std::max(energy[i], 0.0f) + least_energy) /
                                 (std::max(noise[i], 0.0f) / float(samples[k]) + least_energy));
        });
        measures.energy_ratio[k] = std::move(energy);
    }
    Confirmation first = confirmation(offer, 0), second = confirmation(offer, 1);
    for (Values &confirmed : measures.confirmed) confirmed.resize(grid.size());
    for_pixels(grid, [&](std::size_t i) {
        measures.confirmed[0][i] = first.deviations(i);
        measures.confirmed[1][i] = second.deviations(i);
        first.sum[i] += second.sum[i];
        first.variance[i] += second.variance[i];
        measures.confirmed[2][i] = first.deviations(i);
    });
    return measures;
}

} // namespace

void blend_in(Trio &pictures, const Halves &candidate, const RayEvidence &evidence, Values &kept) {
    const Offer offer{pictures, candidate, evidence};
    const Grid &grid = evidence.grid;
    std::array<Values, 2> energies, answers;
    Measures measures = measured(offer, energies);
    for (std::size_t k = 0; k < 2; ++k) {
        answers[k].resize(grid.size());
        for_pixels(grid, [&](std::size_t i) {
            answers[k][i] = answer(offer, k, i).confirmed;
            energies[k][i] *= float(offer.testing(k));
        });
    }

    Classes by_energy(classes, -largest_energy_ratio, largest_energy_ratio),
        by_confirmation(classes, -largest_confirmation, largest_confirmation);
    for (std::size_t i = 0; i < grid.size(); ++i)
        for (std::size_t k = 0; k < 2; ++k) {
            by_energy.add(measures.energy_ratio[k][i], double(energies[k][i]));
            by_confirmation.add(measures.confirmed[k][i], double(energies[k][i]));
        }
    by_energy.divide();
    by_confirmation.divide();

    const Tiles blocks(grid.box(), FinishTuning::block_px);
    const std::vector<Table> zero(blocks.count(), Table{});
    ClassSums sums{zero, zero, zero};
    const double height = event_height(offer);
    parallel_for(blocks.count(), [&](std::size_t b) {
        const Imath::Box2i box = blocks.box(b);
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                const std::size_t i = grid.index(x, y);
                for (std::size_t k = 0; k < 2; ++k) {
                    const std::size_t cell = by_energy.of(measures.energy_ratio[k][i]) * classes +
                                             by_confirmation.of(measures.confirmed[k][i]);
                    sums.answers[b][cell] += double(answers[k][i]);
                    sums.energies[b][cell] +=
                        double(energies[k][i]) + noise_of_change(offer, k, i) * FinishTuning::noise_costs;
                    sums.unseen[b][cell] += unseen_variance(offer, k, i, height);
                }
            }
    });
    const Table shares = shares_of(sums);

    for (std::size_t k = 0; k < 3; ++k) {
        Values &share = measures.energy_ratio[k];
        for_pixels(grid, [&](std::size_t i) {
            share[i] = share_at(shares, by_confirmation.place_of(measures.confirmed[k][i]),
                                by_energy.place_of(share[i]));
        });
        soft_mean(share, grid, FinishTuning::trust_radius);
    }
    // The changes are those of pictures that are not changed yet, so each pixel is changed last.
    for_pixels(grid, [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < pictures[k].size(); ++c)
                pictures[k][c][i] += measures.energy_ratio[k][i] * offer.change(k, c, i);
        kept[i] *= 1 - measures.energy_ratio[2][i];
    });
}

} // namespace sparselens
