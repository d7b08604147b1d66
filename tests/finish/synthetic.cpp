#include "finish/synthetic.h"

#include "base/light.h"
#include "finish/cross_validation.h"
#include "finish/window_means.h"

#include <cmath>
#include <random>

namespace sparselens {

Colours synthetic_truth(const ArrayGrid &grid, int variant) {
    Colours truth(3, Values(grid.size()));
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Position here = grid.position(i);
        const Imath::V2i at = variant == 0 ? here - Position() : Position(grid.height(), grid.width()) - here;
        const double slope = 0.2 + 0.6 * at.x / grid.width();
        const double texture = 0.15 * std::sin(at.x * 0.7) * std::sin(at.y * 0.45);
        const bool card = std::hypot(at.x - grid.width() / 3, at.y - grid.height() / 2) < grid.height() / 4;
        for (std::size_t c = 0; c < 3; ++c)
            truth[c][i] = float(card ? 0.1 + 0.3 * double(c) : slope + texture * (1 - 0.2 * double(c)));
        if (at.x / 3 == 20 && at.y / 3 == 3)
            for (Values &channel : truth) channel[i] = 30;
    }
    return truth;
}

Colours rays_of(const Colours &truth, double samples, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Colours rays = truth;
    for (Values &channel : rays)
        for (float &v : channel) v += float(normal(random) * (0.5 * double(v) + 0.05) / std::sqrt(samples));
    return rays;
}

LayerToFinish layer_of(const ArrayGrid &grid, const Colours &truth, Colours gathered,
                       const std::array<double, 2> &samples, std::uint32_t seed) {
    return {grid,
            std::move(gathered),
            {rays_of(truth, samples[0], 2 * seed), rays_of(truth, samples[1], 2 * seed + 1)},
            samples};
}

Colours mean_of(const Halves &rays, const std::array<double, 2> &samples) {
    Colours mean = rays[0];
    for (std::size_t c = 0; c < mean.size(); ++c)
        for (std::size_t i = 0; i < mean[c].size(); ++i)
            mean[c][i] = float((samples[0] * double(rays[0][c][i]) + samples[1] * double(rays[1][c][i])) /
                               (samples[0] + samples[1]));
    return mean;
}

double decibels_of(const Colours &picture, const Colours &truth) {
    double sum = 0;
    for (std::size_t c = 0; c < truth.size(); ++c)
        for (std::size_t i = 0; i < truth[c].size(); ++i) {
            const double d = tone_mapped(double(picture[c][i])) - tone_mapped(double(truth[c][i]));
            sum += d * d;
        }
    return -10 * std::log10(sum / double(truth.size() * truth[0].size()));
}

Colours blurred(Colours colours, const ArrayGrid &grid, int radius) {
    for (Values &channel : colours) box_mean(channel, grid, radius);
    return colours;
}

FinishedLayer finished(const LayerToFinish &layer) {
    Progress silent;
    return finish_layer(layer, silent);
}

} // namespace sparselens
