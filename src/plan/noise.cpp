#include "plan/noise.h"

#include "base/parallel.h"
#include "plan/tuning.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace sparselens {

namespace {

constexpr int block_size = 8;

// Variance of the noise in the block at `corner`, which lies inside the picture's border, measured by second differences
// in steps of `step` pixels; 0 if they are not Gaussian.
double variance_along(const std::vector<double> &picture, const ArrayGrid &grid, const Position &corner,
                      std::ptrdiff_t step) {
    const ArrayGrid block(block_size, block_size);
    std::array<double, block_size * block_size> residual;
    for (std::size_t i = 0; i < residual.size(); ++i) {
        const double *p = &picture[grid.index(corner + (block.position(i) - Position()))];
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
double block_variance(const std::vector<double> &picture, const ArrayGrid &grid, const Position &corner) {
    constexpr double least_of_four =
        0.63; // the least of four measurements of Gaussian noise, relative to its variance
    const std::ptrdiff_t row = grid.width();
    double least = std::numeric_limits<double>::infinity();
    for (const std::ptrdiff_t step : {std::ptrdiff_t{1}, row, row + 1, row - 1})
        least = std::min(least, variance_along(picture, grid, corner, step));
    return least / least_of_four;
}

// The variances of the blocks inside the picture's border, each averaged with the blocks around it.
class BlockVariances {
public:
    BlockVariances(const Image &image, const ArrayGrid &grid)
        : blocks_(std::max((grid.width() - 2) / block_size, 0),
                  std::max((grid.height() - 2) / block_size, 0)),
          variance_(blocks_.size()) {
        const std::vector<double> picture = brightness(image);
        std::vector<double> own(blocks_.size());
        parallel_for(own.size(), [&](std::size_t i) {
            const Imath::V2i from_corner = (blocks_.position(i) - Position()) * block_size;
            own[i] = block_variance(picture, grid, Position(1, 1) + from_corner);
        });
        for (std::size_t i = 0; i < own.size(); ++i)
            if (noise_around(own, blocks_.position(i))) variance_[i] = mean_around(own, blocks_.position(i));
    }

    // The variance of the block that holds the pixel, or of the nearest block.
    double at(const Position &pixel) const {
        if (variance_.empty()) return 0;
        return variance_[blocks_.index(
            Position(std::clamp((pixel.column - 1) / block_size, 0, blocks_.width() - 1),
                     std::clamp((pixel.row - 1) / block_size, 0, blocks_.height() - 1)))];
    }

private:
    // Calls visit(a block's own variance) for the block and the blocks around it.
    template <typename Visit>
    void around(const std::vector<double> &own, const Position &block, int reach, const Visit &visit) const {
        for (int y = block.row - reach; y <= block.row + reach; ++y)
            for (int x = block.column - reach; x <= block.column + reach; ++x)
                if (blocks_.contains(Position(x, y))) visit(own[blocks_.index(Position(x, y))]);
    }

    // Noise is everywhere, but aliased texture looks like it here and there.
    bool noise_around(const std::vector<double> &own, const Position &block) const {
        int gaussian = 0, count = 0;
        around(own, block, PlanTuning::noise_surroundings, [&](double variance) {
            gaussian += variance > 0;
            ++count;
        });
        return gaussian >= PlanTuning::least_gaussian * count;
    }

    double mean_around(const std::vector<double> &own, const Position &block) const {
        double sum = 0;
        int count = 0;
        around(own, block, 1, [&](double variance) {
            sum += variance;
            ++count;
        });
        return sum / count;
    }

    ArrayGrid blocks_;
    std::vector<double> variance_;
};

} // namespace

std::vector<double> noise_in_lens_picture(const Image &image, std::span<const float> z, const ThinLens &lens,
                                          std::optional<double> deviation) {
    const ArrayGrid grid(image.windows.width(), image.windows.height());
    const auto measured =
        deviation ? std::nullopt : std::optional<BlockVariances>(std::in_place, image, grid);
    std::vector<double> noise(grid.size());
    for (std::size_t i = 0; i < noise.size(); ++i) {
        const double coc = circle_of_confusion(lens, z[i]);
        const double variance = measured ? measured->at(grid.position(i)) : *deviation * *deviation;
        noise[i] = variance / std::max(1.0, std::numbers::pi * coc * coc);
    }
    return noise;
}

namespace {

// The pixels over which each pixel's light spreads, corners included.
using Squares = std::vector<PositionBox>;

Squares squares_of(const ArrayGrid &grid, std::span<const float> z, const ThinLens &lens, int across) {
    const double side_of_disc = std::sqrt(std::numbers::pi) / 2; // half of the side, for a radius of 1
    Squares squares(grid.size());
    for (std::size_t i = 0; i < squares.size(); ++i) {
        const double longest = std::max(grid.width(), grid.height());
        const double half = std::min(std::abs(circle_of_confusion(lens, z[i])) * side_of_disc, longest);
        // A pixel of the picture averages at least itself and its neighbours.
        const Imath::V2i reach(std::max(int(std::lround(half - 0.5)), across),
                               std::max(int(std::lround(half * lens.pixel_aspect - 0.5)), across));
        const Position first = grid.position(i) - reach, last = grid.position(i) + reach;
        squares[i] = {
            Position(std::max(first.column, 0), std::max(first.row, 0)),
            Position(std::min(last.column, grid.width() - 1), std::min(last.row, grid.height() - 1))};
    }
    return squares;
}

// For each pixel, the sum of the values whose squares cover it; each value is spread evenly over its square.
std::vector<double> spread(const ArrayGrid &grid, const Squares &squares, std::span<const double> values) {
    const auto row = std::size_t(grid.width()) + 1;
    std::vector<double> sums(row * (std::size_t(grid.height()) + 1));
    const auto corner = [&](int x, int y) -> double & { return sums[std::size_t(y) * row + std::size_t(x)]; };
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto &[from, to] = squares[i];
        const int right = to.column + 1, bottom = to.row + 1;
        const double value = values[i] / (double(right - from.column) * double(bottom - from.row));
        corner(from.column, from.row) += value;
        corner(right, from.row) -= value;
        corner(from.column, bottom) -= value;
        corner(right, bottom) += value;
    }
    std::vector<double> all(values.size());
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x) {
            if (y > 0) corner(x, y) += corner(x, y - 1);
            all[grid.index(Position(x, y))] = corner(x, y);
        }
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 1; x < grid.width(); ++x)
            all[grid.index(Position(x, y))] += all[grid.index(Position(x - 1, y))];
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
    const ArrayGrid grid(image.windows.width(), image.windows.height());
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
