#include "plan/noise_of_rays.h"

#include "base/tone_map.h"
#include "plan/tuning.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace sparselens {

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
