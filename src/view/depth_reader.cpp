#include "view/depth_reader.h"

#include "view/resolve_lens.h"

#include <limits>
#include <utility>

namespace sparselens {

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
