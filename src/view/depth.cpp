#include "view/depth.h"

#include "view/view_mapping.h"

#include <cmath>

namespace sparselens {

bool is_sky(DepthMeaning meaning, double value, double far) {
    constexpr double largest_half = 65504;
    if (meaning == DepthMeaning::inverse) return value >= 0 && value <= 1 / far;
    if (meaning == DepthMeaning::normalized || meaning == DepthMeaning::hyperbolic) return value >= 1;
    const double depth =
        meaning == DepthMeaning::negative ? std::abs(value) : value; // the sky may be positive
    return depth >= far || depth == largest_half;
}

double planar_depth(DepthMeaning meaning, double value, int x, int y, const Windows &windows, double focal_px,
                    const Imath::V2d &principal_point) {
    if (meaning == DepthMeaning::planar) return value;
    if (meaning == DepthMeaning::negative) return -value;
    if (meaning == DepthMeaning::inverse) return 1 / (value == 0 ? 0.0 : value); // -0 is infinitely far too
    const Imath::V2d axis = in_pixels(principal_point, windows);
    const double right = x + 0.5 - axis.x;
    const double down = (y + 0.5 - axis.y) / windows.pixel_aspect;
    return value / std::sqrt(1 + (right * right + down * down) / (focal_px * focal_px));
}

double hyperbolic_depth(double value, const DepthRange &range) {
    return range.near / (1 - value * (1 - range.near / range.far));
}

double normalized_depth(double value, const DepthRange &range) {
    if (std::isinf(range.far)) return value < 1 ? range.near / (1 - value) : range.far;
    return range.near + value * (range.far - range.near);
}

} // namespace sparselens
