#include "view/view.h"

#include "base/error.h"
#include "view/lens_views.h"

#include <fmt/format.h>

#include <cmath>

namespace sparselens {

void complete_field(Camera &camera) {
    auto &focal = camera.focal_length_mm, &width = camera.sensor_width_mm;
    if (focal && width)
        camera.field = *width / *focal;
    else if (focal && camera.field && !camera.unsure.contains("sensor_width"))
        width = *focal * *camera.field;
    else if (width && camera.field && !camera.unsure.contains("focal_length"))
        focal = *width / *camera.field;
}

std::optional<double> focal_length_px(const Camera &camera, int display_width) {
    if (camera.focal_length_mm && camera.sensor_width_mm)
        return display_width * *camera.focal_length_mm / *camera.sensor_width_mm;
    if (!camera.field) return {};
    return display_width / *camera.field;
}

namespace {

// The field by the projection matrix, unless options have changed it.
std::optional<double> projected_field(const Camera &camera) {
    if (!camera.world_to_ndc || !camera.world_to_camera) return {};
    const auto frustum = frustum_of(*camera.world_to_ndc, *camera.world_to_camera);
    if (!frustum || (camera.field && std::abs(frustum->field / *camera.field - 1) > 0.01)) return {};
    return frustum->field;
}

double relative_zoom(const Camera &centre, const Camera &view) {
    const auto centre_field = projected_field(centre), field = projected_field(view);
    if (centre_field && field) return *centre_field / *field;
    return centre.field && view.field ? *centre.field / *view.field : 1;
}

} // namespace

Framing framing_relative_to(const Camera &centre, const Camera &view, const std::string &what) {
    constexpr double rounding = 4e-6; // a sixtieth of a pixel in a picture of 4096
    const Imath::V2d axis = centre.principal_point.value_or(Imath::V2d(0, 0));
    Framing framing{0, relative_zoom(centre, view), view.principal_point.value_or(axis)};
    if (!(framing.zoom >= 0.5 && framing.zoom <= 2))
        throw Error(
            fmt::format("{}: its focal length is too far from that of the centre view, {:g} times as long: "
                        "give `focal_length` and `sensor_width` to set both",
                        what, framing.zoom));
    if (std::abs(framing.zoom - 1) < rounding) framing.zoom = 1;
    if ((framing.principal_point - axis).length() < rounding) framing.principal_point = axis;
    return framing;
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
