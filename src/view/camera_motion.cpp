#include "view/camera_motion.h"

#include "view/view_mapping.h"

#include <cmath>
#include <limits>

namespace sparselens {

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
