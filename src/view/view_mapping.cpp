#include "view/view_mapping.h"

#include <cmath>
#include <limits>

namespace sparselens {

Imath::V2d in_pixels(const Imath::V2d &principal_point, const Windows &windows) {
    const Imath::Box2i &display = windows.display;
    const Imath::V2d middle((double(display.min.x) + display.max.x + 1) / 2,
                            (double(display.min.y) + display.max.y + 1) / 2);
    const double width = double(display.max.x) - display.min.x + 1;
    return middle + width * Imath::V2d(principal_point.x, principal_point.y * windows.pixel_aspect);
}

ViewMapping::ViewMapping(const Imath::V2d &position, double focal_px, const Windows &windows,
                         const Framing &view, const Imath::V2d &centre_principal_point)
    : unzoom_(1 / view.zoom), approach_(view.forward * unzoom_) {
    const Imath::V2d own = in_pixels(view.principal_point, windows);
    offset_ = in_pixels(centre_principal_point, windows) - own * unzoom_;
    step_ =
        Imath::V2d(focal_px * position.x, -focal_px * position.y * windows.pixel_aspect) + own * approach_;
}

Imath::V2d ViewMapping::in_view(const Imath::V2d &p, double inverse_z) const {
    const double scale =
        kernels::scale_in_view(unzoom_, approach_, inverse_z); // depth ratio to the centre view, over s
    if (!(scale > 0)) return Imath::V2d(std::numeric_limits<double>::quiet_NaN());
    return {kernels::place_in_view(p.x, offset_.x, step_.x, inverse_z, scale),
            kernels::place_in_view(p.y, offset_.y, step_.y, inverse_z, scale)};
}

Imath::V2d CameraMotion::moved(const Imath::V2d &p, double z) const {
    const Imath::V2d d = (p - from_.axis) / from_.focal;
    const Imath::V3d ray(d.x, -d.y / from_.aspect, 1);
    Imath::V3d there;
    if (std::isfinite(z))
        between_.multVecMatrix(ray * z, there);
    else
        between_.multDirMatrix(ray, there);
    if (!(there.z > 0)) return Imath::V2d(std::numeric_limits<double>::quiet_NaN());
    return to_.axis + Imath::V2d(there.x, -there.y * to_.aspect) * (to_.focal / there.z);
}

std::optional<CameraMotion::Pinhole> CameraMotion::pinhole_of(const Camera &camera, const Windows &windows) {
    const std::optional<double> focal = focal_length_px(camera, windows.display_width());
    if (!focal) return {};
    return Pinhole{*focal, double(windows.pixel_aspect),
                   in_pixels(camera.principal_point.value_or(Imath::V2d(0, 0)), windows)};
}

std::optional<CameraMotion> camera_motion(const Camera &from, const Camera &to, const Windows &windows) {
    const auto one = CameraMotion::pinhole_of(from, windows), other = CameraMotion::pinhole_of(to, windows);
    if (!one || !other || !from.world_to_camera || !to.world_to_camera) return {};
    CameraMotion motion;
    motion.from_ = *one;
    motion.to_ = *other;
    motion.between_ = from.world_to_camera->inverse() * *to.world_to_camera;
    return motion;
}

} // namespace sparselens
