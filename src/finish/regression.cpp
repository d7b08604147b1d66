#include "finish/regression.h"

#include "base/parallel.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

namespace sparselens {

namespace {

// Keeps the prior above 0 where the guide is black.
constexpr float least_square = 1e-4f;

// The mean of `of(i)` over soft windows around cells.
template <typename Of>
Values averaged(const Cells &cells, int radius, const Of &of) {
    Values means(cells.grid().size(), 0.0f);
    const auto width = std::size_t(cells.pixels().width());
    parallel_for(std::size_t(cells.grid().height()), [&](std::size_t row) {
        const std::span<float> sums = cells.of_row(means, row);
        const auto [begin, end] = cells.rows(row);
        for (std::size_t y = begin; y < end; ++y)
            for (std::size_t x = 0; x < width; x += run_length) {
                Run run{};
                const std::size_t first = y * width + x, count = std::min(run_length, width - x);
                for (std::size_t i = 0; i < count; ++i) run[i] = of(first + i);
                cells.add(run, x, sums);
            }
        cells.divide(row, sums);
    });
    soft_mean(means, cells.grid(), radius);
    return means;
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
                       const FinishTuning::Window &window)
    : guide_(guide), weights_(weights), cells_(grid, window.cell), radius_(window.radius) {
    weight_ = averaged(cells_, radius_, [&](std::size_t i) { return weights[i]; });
    mean_ = averaged(cells_, radius_, [&](std::size_t i) { return weights[i] * guide[i]; });
    variance_ = averaged(cells_, radius_, [&](std::size_t i) { return weights[i] * guide[i] * guide[i]; });
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        mean_[i] /= weight_[i];
        variance_[i] = std::max(variance_[i] / weight_[i] - mean_[i] * mean_[i], 0.0f);
    }
}

Values Regression::of(std::span<const float> rays) const {
    // The lines: slope * guide + level.
    Values level = averaged(cells_, radius_, [&](std::size_t i) { return weights_[i] * rays[i]; });
    Values slope =
        averaged(cells_, radius_, [&](std::size_t i) { return weights_[i] * guide_[i] * rays[i]; });
    double covariances = 0, variances = 0;
    for (std::size_t i = 0; i < level.size(); ++i) {
        covariances += double(slope[i] - mean_[i] * level[i]);
        variances += double(weight_[i] * variance_[i]);
    }
    const auto of_all = variances > 0 ? float(covariances / variances) : 0.0f;
    for (std::size_t i = 0; i < level.size(); ++i) {
        const float y = level[i] / weight_[i], covariance = slope[i] / weight_[i] - mean_[i] * y;
        const float prior = FinishTuning::regression_prior * (least_square + mean_[i] * mean_[i]);
        slope[i] = (covariance + prior * of_all) / (variance_[i] + prior);
        level[i] = y - slope[i] * mean_[i];
    }
    Values found(guide_.size());
    const auto width = std::size_t(cells_.pixels().width());
    parallel_for(std::size_t(cells_.pixels().height()), [&](std::size_t y) {
        std::vector<float> slopes, levels;
        cells_.interpolate(slope, y, slopes);
        cells_.interpolate(level, y, levels);
        for (std::size_t x = 0; x < width; ++x)
            found[y * width + x] = levels[x] + slopes[x] * guide_[y * width + x];
    });
    return found;
}

} // namespace sparselens
