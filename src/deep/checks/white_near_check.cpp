#include "deep/checks/picture_checks.h"
#include "deep/checks/picture_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr std::size_t enough = 200;      // slopes
constexpr double mostly = 0.5;           // of the slopes
constexpr double hardly = 0.1;           // of the slopes
constexpr double clearly = 0.01;         // bend, relative to the change over the slope
constexpr double smooth = 0.4;           // the smallest of four steps, relative to their mean
constexpr std::size_t shortest = 2;      // pixels, of a step
constexpr std::size_t steps_across = 96; // of a picture

// How far the middle of a slope lies above the mean of its ends, relative to their difference; 0 if it is not a slope.
double bend_of(const std::array<double, 5> &v) {
    const double step = (v[4] - v[0]) / 4;
    if (!(std::min(v[0], v[4]) > 0) || step == 0) return 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double own = (v[i + 1] - v[i]) / step;
        if (!(own > smooth && own < 1 / smooth)) return 0;
    }
    return ((v[0] + v[4]) / 2 - v[2]) / std::abs(v[4] - v[0]);
}

} // namespace

DepthBends bends_of_depth(const Grid &grid, std::span<const float> depths) {
    const auto across = std::size_t(std::max(grid.width(), grid.height()));
    const std::size_t step = std::max(shortest, across / steps_across);
    std::size_t all = 0, upward = 0, downward = 0;
    visit_lines(grid, [&](const PictureLine &line) {
        for (std::size_t i = 0; i + 4 * step < line.length; ++i) {
            std::array<double, 5> v{};
            for (std::size_t k = 0; k < v.size(); ++k) v[k] = double(depths[line[i + k * step]]);
            const double bend = bend_of(v);
            if (bend == 0) continue;
            ++all;
            upward += bend > clearly;
            downward += bend < -clearly;
        }
    });
    if (all == 0) return {};
    return {all, double(upward) / double(all), double(downward) / double(all)};
}

bool looks_white_near(const Grid &grid, std::span<const float> depths) {
    if (!std::ranges::all_of(depths, [](float v) { return v >= 0 && v <= 1; })) return false;
    const DepthBends bends = bends_of_depth(grid, depths);
    return bends.slopes >= enough && bends.downward > mostly && bends.upward < hardly;
}

} // namespace sparselens
