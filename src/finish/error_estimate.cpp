#include "finish/error_estimate.h"

#include "base/parallel.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// The squared slope of the curve of light.h.
float shown_slope(float value) {
    const float v = std::max(value, FinishTuning::darkest), mapped = v / (1 + v);
    const float slope = std::pow(mapped, 1 / 2.2f - 1) / 2.2f / ((1 + v) * (1 + v));
    return slope * slope;
}

// The mean of a plane, and the standard deviation of the mean, from the differences between its blocks.
std::array<double, 2> mean_and_deviation(const Values &values, const ArrayGrid &grid) {
    const Tiles blocks(grid.box(), FinishTuning::block_px);
    std::vector<double> sums(blocks.count(), 0);
    for (std::size_t b = 0; b < blocks.count(); ++b) {
        const PositionBox box = blocks.box(b);
        for (int y = box.min.row; y <= box.max.row; ++y)
            for (int x = box.min.column; x <= box.max.column; ++x)
                sums[b] += double(values[grid.index(Position(x, y))]);
    }
    double sum = 0, squares = 0;
    for (const double block : sums) sum += block;
    const double mean_block = sum / double(sums.size());
    for (const double block : sums) squares += (block - mean_block) * (block - mean_block);
    return {sum / double(grid.size()), std::sqrt(squares) / double(grid.size())};
}

} // namespace

ErrorEstimate estimate_error(const FinishedLayer &finished, const Halves &rays, const RayCounts &samples,
                             const ArrayGrid &grid) {
    ErrorEstimate error;
    error.map.resize(grid.size());
    Values of_one(grid.size());
    parallel_for(std::size_t(grid.height()), [&](std::size_t row) {
        for (std::size_t i = row * std::size_t(grid.width()); i < (row + 1) * std::size_t(grid.width());
             ++i) {
            const auto [n, m] = samples.at(i);
            const float noise_share = n * m / ((n + m) * (n + m));
            float sum = 0, sum_of_one = 0;
            for (std::size_t c = 0; c < finished.picture.size(); ++c) {
                const float f = finished.of_one[0][c][i], g = finished.of_one[1][c][i];
                const float x = rays[0][c][i], y = rays[1][c][i], slope = shown_slope(finished.picture[c][i]);
                const float bias = (f - y) * (g - x) + (f - g) * (x - y), spread = (f - g) * (f - g);
                sum += slope * (bias + noise_share * spread);
                sum_of_one += slope * (bias + spread / 2);
            }
            error.map[i] = sum / float(finished.picture.size());
            of_one[i] = sum_of_one / float(finished.picture.size());
        }
    });
    const auto [mean, deviation] = mean_and_deviation(error.map, grid);
    error.mean = mean;
    error.standard_deviation = deviation;
    error.of_one = mean_and_deviation(of_one, grid)[0];
    soft_mean(error.map, grid, FinishTuning::error_radius);
    for (float &e : error.map) e = std::max(e, 0.0f);
    return error;
}

std::optional<double> decibels(const ErrorEstimate &error) {
    if (!(error.mean > 2 * error.standard_deviation)) return {};
    return -10 * std::log10(error.mean);
}

double fall_of(const ErrorEstimate &error, const std::array<double, 2> &samples) {
    const double all = samples[0] + samples[1], one = std::sqrt(samples[0] * samples[1]);
    const double fall = std::log(std::max(error.of_one / error.mean, 1.0)) / std::log(all / one);
    // Between a fall that is hardly noticeable and the best possible fall of noise.
    return std::clamp(fall, 0.25, 1.0);
}

std::optional<double> times_the_rays(const ErrorEstimate &error, const std::array<double, 2> &samples,
                                     double goal) {
    const auto now = decibels(error);
    if (!now) return {};
    if (goal <= *now) return 1;
    return std::pow(10, (goal - *now) / 10 / fall_of(error, samples));
}

} // namespace sparselens
