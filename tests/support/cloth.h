// A smooth texture between random values at every fourth pixel, at any position.
#pragma once

#include <cmath>

namespace sparselens {

inline double cloth(double x, double y) {
    const auto random_at = [](double i, double j) {
        const double value = std::sin(i * 12.9898 + j * 78.233) * 43758.5453;
        return value - std::floor(value);
    };
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double left = std::floor(x / 4), top = std::floor(y / 4);
    const double s = smooth(x / 4 - left), t = smooth(y / 4 - top);
    return 0.05 + std::lerp(std::lerp(random_at(left, top), random_at(left + 1, top), s),
                            std::lerp(random_at(left, top + 1), random_at(left + 1, top + 1), s), t);
}

} // namespace sparselens
