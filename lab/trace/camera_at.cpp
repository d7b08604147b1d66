#include "lab/trace/camera_at.h"

namespace sparselens::lab {

Camera camera_at(const Camera &camera, const Windows &windows, const Imath::V2d &offset,
                 const Placement &placement) {
    Camera moved = camera;
    Imath::M44d &to_camera = moved.world_to_camera.emplace();
    for (int axis = 0; axis < 3; ++axis) {
        Imath::V3d unit(0, 0, 0);
        unit[axis] = 1;
        const Imath::V3d seen = placement.direction_at_rest(unit);
        for (int k = 0; k < 3; ++k) to_camera[axis][k] = 0 + seen[k]; // no negative zero
    }
    const Imath::V3d origin = placement.point_at_rest({0, 0, 0}) - Imath::V3d(offset.x, offset.y, 0);
    for (int k = 0; k < 3; ++k) to_camera[3][k] = 0 + origin[k];
    // x = 1/2 + f X / Z across the display window; y likewise, downwards; depth 1 - 1 / Z only keeps it invertible.
    const double across = *camera.focal_length_mm / *camera.sensor_width_mm;
    const double down =
        across * windows.display_width() * double(windows.pixel_aspect) / windows.display_height();
    const Imath::M44d projection(across, 0, 0, 0, 0, -down, 0, 0, 0.5, 0.5, 1, 1, 0, 0, -1, 0);
    moved.world_to_ndc = to_camera * projection;
    return moved;
}

} // namespace sparselens::lab
