#include "finish/regression.h"

#include "base/parallel.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

namespace sparselens {

namespace {

constexpr std::size_t grain = 1 << 16; // pixels that a thread takes at once

// Keeps the prior above 0 where the guide is black.
constexpr float least_square = 1e-4f;

// `of(i)` for each pixel, averaged over soft windows.
template <typename Of>
Values averaged(const Grid &grid, int radius, const Of &of) {
    Values values(grid.size());
    parallel_ranges(grid.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) values[i] = of(i);
    });
    soft_mean(values, grid, radius);
    return values;
}

} // namespace

Values tone_weights(const Colours &guide) {
    Values weights(guide.front().size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const float reciprocal = 1 / (1 + brightness(guide, i));
        weights[i] = reciprocal * reciprocal;
    }
    return weights;
}

Regression::Regression(std::span<const float> guide, std::span<const float> weights, const Grid &grid,
                       int radius)
    : guide_(guide), weights_(weights), grid_(grid), radius_(radius) {
    weight_ = averaged(grid, radius, [&](std::size_t i) { return weights[i]; });
    mean_ = averaged(grid, radius, [&](std::size_t i) { return weights[i] * guide[i]; });
    variance_ = averaged(grid, radius, [&](std::size_t i) { return weights[i] * guide[i] * guide[i]; });
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        mean_[i] /= weight_[i];
        variance_[i] = std::max(variance_[i] / weight_[i] - mean_[i] * mean_[i], 0.0f);
    }
}

Values Regression::of(std::span<const float> rays) const {
    Values level = averaged(grid_, radius_, [&](std::size_t i) { return weights_[i] * rays[i]; });
    const Values product =
        averaged(grid_, radius_, [&](std::size_t i) { return weights_[i] * guide_[i] * rays[i]; });
    double covariances = 0, variances = 0;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
        covariances += double(product[i] - mean_[i] * level[i]);
        variances += double(weight_[i] * variance_[i]);
    }
    const auto slope = variances > 0 ? float(covariances / variances) : 0.0f;
    parallel_ranges(grid_.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float y = level[i] / weight_[i], covariance = product[i] / weight_[i] - mean_[i] * y;
            const float prior = FinishTuning::regression_prior * (least_square + mean_[i] * mean_[i]);
            level[i] = y + (covariance + prior * slope) / (variance_[i] + prior) * (guide_[i] - mean_[i]);
        }
    });
    return level;
}

} // namespace sparselens
