#include "view/depth.h"

#include "lens/photograph.h"
#include "view/resolve_lens.h"
#include "view/view_mapping.h"

#include <cmath>
#include <limits>
#include <utility>

namespace sparselens {

bool is_sky(DepthMeaning meaning, double value, double far) {
    constexpr double largest_half = 65504;
    if (meaning == DepthMeaning::disparity) return false; // large values are near
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
    if (meaning == DepthMeaning::disparity) return depth_of_disparity(value);
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

namespace {

bool is_white_near(DepthMeaning meaning, const DepthRange &range) {
    return (meaning == DepthMeaning::normalized || meaning == DepthMeaning::hyperbolic) &&
           range.near > range.far;
}

} // namespace

DepthReader::DepthReader(const Windows &windows, DepthMeaning meaning, const DepthRange &range,
                         const Camera &camera)
    : windows_(windows), meaning_(meaning), range_(range), white_near_(is_white_near(meaning, range)),
      focal_px_(meaning == DepthMeaning::distance ? resolve_focal_px(camera, windows) : 1),
      principal_point_(camera.principal_point.value_or(Imath::V2d(0, 0))) {
    if (white_near_) std::swap(range_.near, range_.far);
}

float DepthReader::planar(float value, std::size_t i) const {
    const double number = white_near_ ? 1 - double(value) : double(value);
    if (is_sky(meaning_, number, range_.far)) return std::numeric_limits<float>::infinity();
    if (meaning_ == DepthMeaning::planar) return value;
    if (meaning_ == DepthMeaning::normalized) return float(normalized_depth(number, range_));
    if (meaning_ == DepthMeaning::hyperbolic) return float(hyperbolic_depth(number, range_));
    const Imath::V2i p = windows_.pixel(i);
    return float(planar_depth(meaning_, double(value), p.x, p.y, windows_, focal_px_, principal_point_));
}

} // namespace sparselens
