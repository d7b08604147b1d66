#include "plan/noise.h"

#include "base/light.h"
#include "base/parallel.h"
#include "plan/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace sparselens {

namespace {

constexpr int block_size = 8;

// Variance of the noise in the block at (x, y), which lies inside the picture's border, measured by second differences
// in steps of `step` pixels; 0 if they are not Gaussian.
double variance_along(const std::vector<double> &picture, const Grid &grid, int x, int y,
                      std::ptrdiff_t step) {
    const Grid block(block_size, block_size);
    std::array<double, block_size * block_size> residual;
    for (std::size_t i = 0; i < residual.size(); ++i) {
        const Imath::V2i at = block.pixel(i) + Imath::V2i(x, y);
        const double *p = &picture[grid.index(at.x, at.y)];
        residual[i] = std::abs(*p - (p[-step] + p[step]) / 2);
    }
    std::ranges::sort(residual);
    constexpr double spread = 1.5;                   // variance of a value minus the mean of two others
    const auto quantile = [&](std::size_t quarter) { // between two values
        const std::size_t i = quarter * residual.size() / 4;
        return (residual[i - 1] + residual[i]) / 2;
    };
    const double by_quartile = quantile(1) / 0.3186, by_median = quantile(2) / 0.6745;
    return by_quartile > 0.75 * by_median ? by_median * by_median / spread : 0;
}

// The variance along the direction in which the block is smoothest.
double block_variance(const std::vector<double> &picture, const Grid &grid, int x, int y) {
    constexpr double least_of_four =
        0.63; // the least of four measurements of Gaussian noise, relative to its variance
    const std::ptrdiff_t row = grid.width();
    double least = std::numeric_limits<double>::infinity();
    for (const std::ptrdiff_t step : {std::ptrdiff_t{1}, row, row + 1, row - 1})
        least = std::min(least, variance_along(picture, grid, x, y, step));
    return least / least_of_four;
}

// The variances of the blocks inside the picture's border, each averaged with the blocks around it.
class BlockVariances {
public:
    BlockVariances(const Image &image, const Grid &grid)
        : blocks_(std::max((grid.width() - 2) / block_size, 0),
                  std::max((grid.height() - 2) / block_size, 0)),
          variance_(blocks_.size()) {
        const std::vector<double> picture = brightness(image);
        std::vector<double> own(blocks_.size());
        parallel_for(own.size(), [&](std::size_t i) {
            const Imath::V2i at = blocks_.pixel(i) * block_size + Imath::V2i(1);
            own[i] = block_variance(picture, grid, at.x, at.y);
        });
        for (std::size_t i = 0; i < own.size(); ++i)
            if (noise_around(own, blocks_.pixel(i))) variance_[i] = mean_around(own, blocks_.pixel(i));
    }

    // The variance of the block that holds the pixel, or of the nearest block.
    double at(int x, int y) const {
        if (variance_.empty()) return 0;
        return variance_[blocks_.index(std::clamp((x - 1) / block_size, 0, blocks_.width() - 1),
                                       std::clamp((y - 1) / block_size, 0, blocks_.height() - 1))];
    }

private:
    // Calls visit(a block's own variance) for the block and the blocks around it.
    template <typename Visit>
    void around(const std::vector<double> &own, const Imath::V2i &block, int reach,
                const Visit &visit) const {
        for (int y = block.y - reach; y <= block.y + reach; ++y)
            for (int x = block.x - reach; x <= block.x + reach; ++x)
                if (blocks_.contains(x, y)) visit(own[blocks_.index(x, y)]);
    }

    // Noise is everywhere, but aliased texture looks like it here and there.
    bool noise_around(const std::vector<double> &own, const Imath::V2i &block) const {
        int gaussian = 0, count = 0;
        around(own, block, PlanTuning::noise_surroundings, [&](double variance) {
            gaussian += variance > 0;
            ++count;
        });
        return gaussian >= PlanTuning::least_gaussian * count;
    }

    double mean_around(const std::vector<double> &own, const Imath::V2i &block) const {
        double sum = 0;
        int count = 0;
        around(own, block, 1, [&](double variance) {
            sum += variance;
            ++count;
        });
        return sum / count;
    }

    Grid blocks_;
    std::vector<double> variance_;
};

} // namespace

std::vector<double> noise_in_lens_picture(const Image &image, std::span<const float> z, const ThinLens &lens,
                                          std::optional<double> deviation) {
    const Grid grid(image.windows.width(), image.windows.height());
    const auto measured =
        deviation ? std::nullopt : std::optional<BlockVariances>(std::in_place, image, grid);
    std::vector<double> noise(grid.size());
    for (std::size_t i = 0; i < noise.size(); ++i) {
        const Imath::V2i at = grid.pixel(i);
        const double coc = circle_of_confusion(lens, z[i]);
        const double variance = measured ? measured->at(at.x, at.y) : *deviation * *deviation;
        noise[i] = variance / std::max(1.0, std::numbers::pi * coc * coc);
    }
    return noise;
}

namespace {

// The pixels over which each pixel's light spreads, corners included.
using Squares = std::vector<Imath::Box2i>;

Squares squares_of(const Grid &grid, std::span<const float> z, const ThinLens &lens, int across) {
    const double side_of_disc = std::sqrt(std::numbers::pi) / 2; // half of the side, for a radius of 1
    Squares squares(grid.size());
    for (std::size_t i = 0; i < squares.size(); ++i) {
        const double longest = std::max(grid.width(), grid.height());
        const double half = std::min(std::abs(circle_of_confusion(lens, z[i])) * side_of_disc, longest);
        // A pixel of the picture averages at least itself and its neighbours.
        const Imath::V2i reach(std::max(int(std::lround(half - 0.5)), across),
                               std::max(int(std::lround(half * lens.pixel_aspect - 0.5)), across));
        const Imath::V2i at = grid.pixel(i);
        squares[i] = {
            {std::max(at.x - reach.x, 0), std::max(at.y - reach.y, 0)},
            {std::min(at.x + reach.x, grid.width() - 1), std::min(at.y + reach.y, grid.height() - 1)}};
    }
    return squares;
}

// For each pixel, the sum of the values whose squares cover it; each value is spread evenly over its square.
std::vector<double> spread(const Grid &grid, const Squares &squares, std::span<const double> values) {
    const auto row = std::size_t(grid.width()) + 1;
    std::vector<double> sums(row * (std::size_t(grid.height()) + 1));
    const auto corner = [&](int x, int y) -> double & { return sums[std::size_t(y) * row + std::size_t(x)]; };
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto &[from, to] = squares[i];
        const double value = values[i] / (double(to.x - from.x + 1) * double(to.y - from.y + 1));
        corner(from.x, from.y) += value;
        corner(to.x + 1, from.y) -= value;
        corner(from.x, to.y + 1) -= value;
        corner(to.x + 1, to.y + 1) += value;
    }
    std::vector<double> all(values.size());
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x) {
            if (y > 0) corner(x, y) += corner(x, y - 1);
            all[grid.index(x, y)] = corner(x, y);
        }
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 1; x < grid.width(); ++x) all[grid.index(x, y)] += all[grid.index(x - 1, y)];
    return all;
}

// The square of the tone-mapped noise of a pixel of this mean and variance of linear values. If few of the points are
// bright, 1 / `relative` is how many of the rays meet one of them, as with a lamp; the pixel is black if none does.
double seen_noise(double mean, double variance) {
    if (!(mean > 0) || !(variance > 0)) return 0;
    const double relative = variance / (mean * mean), missed = std::exp(-1 / relative);
    const double seen = tone_mapped(mean), slope = seen / (2.2 * (1 + mean));
    return missed * seen * seen + (1 - missed) * std::min(slope * slope * relative, seen * seen);
}

} // namespace

double noise_of_rays(const Image &image, std::span<const float> z, const ThinLens &lens, int across,
                     int rays) {
    const Grid grid(image.windows.width(), image.windows.height());
    const Squares squares = squares_of(grid, z, lens, across);
    std::vector<double> values(grid.size(), 1.0);
    const std::vector<double> weights = spread(grid, squares, values);
    double noise = 0, channels = 0;
    for (const std::size_t channel : find_rgb(image.channels)) {
        if (channel == npos) continue;
        ++channels;
        const auto plane = image.plane(channel);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = std::clamp(double(plane[i]), 0.0, PlanTuning::brightest);
        const std::vector<double> light = spread(grid, squares, values);
        for (double &value : values) value *= value;
        const std::vector<double> squared = spread(grid, squares, values);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!(weights[i] > 0)) continue;
            const double mean = light[i] / weights[i];
            noise += seen_noise(mean, (squared[i] / weights[i] - mean * mean) / rays);
        }
    }
    return channels > 0 ? noise / (channels * double(grid.size())) : 0;
}

} // namespace sparselens
