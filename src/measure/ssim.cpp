#include "measure/ssim.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace sparselens {

namespace {

// Weighted sums of a, b, a^2, b^2, ab, in double, because a variance is the difference of two nearly equal sums.
constexpr std::size_t moments = 5;
using MomentRows = std::array<std::vector<double>, moments>;

// The moments of each column over the rows of one window.
void add_columns(std::span<const float> a, std::span<const float> b, double weight, MomentRows &sums) {
    for (std::size_t x = 0; x < a.size(); ++x) {
        const double va = a[x], vb = b[x], wa = weight * va, wb = weight * vb;
        sums[0][x] += wa;
        sums[1][x] += wb;
        sums[2][x] += wa * va;
        sums[3][x] += wb * vb;
        sums[4][x] += wa * vb;
    }
}

double similarity(const std::array<double, moments> &m) {
    const double mean_product = m[0] * m[1], mean_squares = m[0] * m[0] + m[1] * m[1];
    const double covariance = m[4] - mean_product, variances = m[2] + m[3] - mean_squares;
    return (2 * mean_product + ssim_c1) * (2 * covariance + ssim_c2) /
           ((mean_squares + ssim_c1) * (variances + ssim_c2));
}

void combine_columns(const MomentRows &columns, std::span<const double> window, std::span<double> row) {
    for (std::size_t x = 0; x < row.size(); ++x) {
        std::array<double, moments> m{};
        for (std::size_t i = 0; i < moments; ++i)
            m[i] =
                std::inner_product(window.begin(), window.end(), columns[i].begin() + std::ptrdiff_t(x), 0.0);
        row[x] = similarity(m);
    }
}

} // namespace

std::vector<double> ssim_window(int size) {
    constexpr double sigma = 1.5;
    std::vector<double> weights(static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double x = (double(i) - (size - 1) / 2.0) / sigma;
        weights[i] = std::exp(-x * x / 2);
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double &w : weights) w /= sum;
    return weights;
}

SsimMap ssim_map(std::span<const float> a, std::span<const float> b, int width, int height) {
    const int size_x = std::min(width, ssim_window_size), size_y = std::min(height, ssim_window_size);
    SsimMap map{width - size_x + 1, height - size_y + 1, size_x / 2, size_y / 2, {}};
    map.values.resize(std::size_t(map.width) * std::size_t(map.height));
    const std::vector<double> window_x = ssim_window(size_x), window_y = ssim_window(size_y);
    const std::size_t row_length = std::size_t(width), map_length = std::size_t(map.width);
    constexpr std::size_t rows_a_task = 16;
    parallel_ranges(std::size_t(map.height), rows_a_task, [&](std::size_t begin, std::size_t end) {
        MomentRows columns;
        for (std::size_t y = begin; y < end; ++y) {
            for (auto &row : columns) row.assign(row_length, 0.0);
            for (std::size_t k = 0; k < window_y.size(); ++k)
                add_columns(a.subspan((y + k) * row_length, row_length),
                            b.subspan((y + k) * row_length, row_length), window_y[k], columns);
            combine_columns(columns, window_x, std::span(map.values).subspan(y * map_length, map_length));
        }
    });
    return map;
}

} // namespace sparselens
