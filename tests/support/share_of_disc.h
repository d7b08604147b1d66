// How much of a blurred edge's disc lies on one side of it, in closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {

// The share of a disc of this radius, averaged over the pixel, on the left of an edge `to_edge` pixels to the right.
inline double share_of_disc(double radius, double to_edge) {
    constexpr int steps = 64; // over the pixel
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = std::clamp((to_edge + (i + 0.5) / steps - 0.5) / radius, -1.0, 1.0);
        sum += 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
    }
    return sum / steps;
}

} // namespace sparselens
