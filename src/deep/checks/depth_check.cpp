#include "deep/checks/picture_checks.h"
#include "deep/checks/picture_lines.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr std::size_t enough = 200;    // slopes
constexpr double mostly = 0.5;         // of them
constexpr std::size_t half_length = 4; // pixels, of a slope
constexpr double least_ratio = 1.04;   // of a slope's end depths; lower ones rather show bent surfaces
constexpr double largest_ratio = 1.5;  // a larger ratio is an edge
constexpr double alike = 0.3;          // largest distance from a mean, where one mean is 0 and the other 1
constexpr double smooth = 0.6;         // the smallest of four steps, relative to their mean

// Where the middle of a slope lies: 0 at the plain mean of its ends, 1 at the harmonic mean. Negative: not a slope.
struct Slope {
    bool found = false;
    double place = 0;
};

template <typename Depth> // depth(i) takes i from 0 to 2 * half_length
Slope slope_of(const Depth &depth) {
    const double a = depth(0), middle = depth(half_length), b = depth(2 * half_length);
    const double ratio = std::max(a, b) / std::min(a, b);
    if (!(ratio > least_ratio && ratio < largest_ratio)) return {}; // rejects sky and empty pixels too
    const double step = (b - a) / 4;
    for (std::size_t i = 0; i < 4; ++i) {
        const double own = depth((i + 1) * half_length / 2) - depth(i * half_length / 2);
        if (!(own / step > smooth && own / step < 1 / smooth)) return {};
    }
    const double mean = (a + b) / 2, harmonic = 2 * a * b / (a + b);
    return {true, (middle - mean) / (harmonic - mean)};
}

} // namespace

DepthSlopes slopes_of_depth(const View &view) {
    std::size_t all = 0, planar = 0, inverse = 0;
    visit_lines(view.image.windows.grid(), [&](const PictureLine &line) {
        for (std::size_t i = 0; i + 2 * half_length < line.length; ++i) {
            const Slope slope = slope_of([&](std::size_t k) { return double(view.z[line[i + k]]); });
            if (!slope.found) continue;
            ++all;
            planar += std::abs(slope.place - 1) < alike;
            inverse += std::abs(slope.place) < alike;
        }
    });
    if (all == 0) return {};
    return {all, double(planar) / double(all), double(inverse) / double(all)};
}

bool looks_inverse(const DepthSlopes &slopes) { return slopes.slopes >= enough && slopes.inverse > mostly; }

} // namespace sparselens
