#include "lens/lens_points.h"

#include <cmath>
#include <numbers>

namespace sparselens {

using std::numbers::pi;

std::vector<Imath::V2d> rim_lens_points(int n) {
    std::vector<Imath::V2d> points;
    for (int k = 0; k < n; ++k) points.emplace_back(std::cos(2 * pi * k / n), std::sin(2 * pi * k / n));
    return points;
}

std::vector<Imath::V2d> spiral_lens_points(int n) {
    if (n == 1) return {{0, 0}};
    const double golden_angle = pi * (3 - std::sqrt(5.0));
    std::vector<Imath::V2d> points;
    for (int k = 0; k < n; ++k) {
        const double r = std::sqrt((k + 0.5) / n), angle = golden_angle * k;
        points.emplace_back(r * std::cos(angle), r * std::sin(angle));
    }
    return points;
}

Imath::V2d disc_point(const Imath::V2d &square) {
    const double a = 2 * square.x - 1, b = 2 * square.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    if (std::abs(a) > std::abs(b)) {
        const double angle = pi / 4 * (b / a);
        return {a * std::cos(angle), a * std::sin(angle)};
    }
    const double angle = pi / 4 * (a / b);
    return {b * std::sin(angle), b * std::cos(angle)};
}

} // namespace sparselens
