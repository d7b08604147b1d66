#include "view/camera.h"

#include "base/error.h"

#include <cmath>

namespace sparselens {

void complete_field(Camera &camera) {
    auto &focal = camera.focal_length_mm, &width = camera.sensor_width_mm;
    if (focal && width)
        camera.field = *width / *focal;
    else if (focal && camera.field && !camera.unsure.contains("--sensor-width"))
        width = *focal * *camera.field;
    else if (width && camera.field && !camera.unsure.contains("--focal-length"))
        focal = *width / *camera.field;
}

std::optional<double> focal_length_px(const Camera &camera, int display_width) {
    if (camera.focal_length_mm && camera.sensor_width_mm)
        return display_width * *camera.focal_length_mm / *camera.sensor_width_mm;
    if (!camera.field) return {};
    return display_width / *camera.field;
}

std::optional<Imath::V3d> position_relative_to(const Camera &centre, const Camera &view,
                                               const std::string &what) {
    if (!centre.world_to_camera || !view.world_to_camera) return {};
    Imath::M44d to_world = *view.world_to_camera;
    try {
        to_world.invert(true);
    } catch (const std::exception &) {
        throw Error(what + ": worldToCamera cannot be inverted");
    }
    const Imath::M44d view_to_centre = to_world * *centre.world_to_camera;
    // The matrices are stored as float: axes that differ by less than its rounding are parallel.
    constexpr double tolerance = 1e-4;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (!(std::abs(view_to_centre[row][column] - (row == column ? 1 : 0)) < tolerance))
                throw Error(what +
                            ": worldToCamera is turned against the centre view's; only parallel axes are "
                            "supported");
    return Imath::V3d(view_to_centre[3][0], view_to_centre[3][1], view_to_centre[3][2]);
}

} // namespace sparselens
