#include "lab/trace/camera_at.h"

namespace sparselens::lab {

Camera camera_at(const Camera &camera, const Windows &windows, const Imath::V2d &offset) {
    Camera moved = camera;
    Imath::M44d &to_camera = moved.world_to_camera.emplace();
    to_camera.setTranslation(Imath::V3d(0 - offset.x, 0 - offset.y, 0)); // 0 - x: no negative zero
    // x = 1/2 + f X / Z across the display window; y likewise, downwards; depth 1 - 1 / Z only keeps it invertible.
    const double across = *camera.focal_length_mm / *camera.sensor_width_mm;
    const double down =
        across * windows.display_width() * double(windows.pixel_aspect) / windows.display_height();
    const Imath::M44d projection(across, 0, 0, 0, 0, -down, 0, 0, 0.5, 0.5, 1, 1, 0, 0, -1, 0);
    moved.world_to_ndc = to_camera * projection;
    return moved;
}

} // namespace sparselens::lab
