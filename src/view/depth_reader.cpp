#include "view/depth_reader.h"

#include "view/resolve_lens.h"

#include <limits>

namespace sparselens {

DepthReader::DepthReader(const Windows &windows, DepthMeaning meaning, const DepthRange &range,
                         const Camera &camera)
    : windows_(windows), meaning_(meaning), range_(range),
      focal_px_(meaning == DepthMeaning::distance ? resolve_focal_px(camera, windows) : 1),
      principal_point_(camera.principal_point.value_or(Imath::V2d(0, 0))) {}

float DepthReader::planar(float value, std::size_t i) const {
    if (is_sky(meaning_, double(value), range_.far)) return std::numeric_limits<float>::infinity();
    if (meaning_ == DepthMeaning::planar) return value;
    if (meaning_ == DepthMeaning::normalized) return float(normalized_depth(double(value), range_));
    if (meaning_ == DepthMeaning::hyperbolic) return float(hyperbolic_depth(double(value), range_));
    const Imath::V2i p = windows_.pixel(i);
    return float(planar_depth(meaning_, double(value), p.x, p.y, windows_, focal_px_, principal_point_));
}

} // namespace sparselens
