#include "plan/plan_cameras.h"

#include "view/lens_views.h"

#include <fmt/format.h>

namespace sparselens {

namespace {

PlannedCamera camera_at(const Camera &centre, const Imath::V2d &offset, std::string name) {
    return {std::move(name), offset, moved_across_lens(centre, offset).world_to_camera};
}

} // namespace

PlannedCameras cameras_of(const Plan &plan, const Camera &camera, const ThinLens &lens, int display_width) {
    PlannedCameras result;
    const double width = display_width / lens.focal_px;
    const Imath::V2d axis =
        camera.principal_point.value_or(Imath::V2d(0, 0)); // to the right of and below the middle
    result.window = {width, {0 - axis.x * width, axis.y * width}};
    result.cameras.push_back(camera_at(camera, {0, 0}, "center"));
    for (std::size_t k = 0; k < plan.views.size(); ++k)
        result.cameras.push_back(camera_at(camera, plan.views[k].u * lens.radius, fmt::format("view_{}", k)));
    return result;
}

Imath::M44d camera_to_world_looking_back(const Imath::M44d &world_to_camera) {
    Imath::M44d placement = world_to_camera.inverse();
    for (int column = 0; column < 3; ++column) placement[2][column] = -placement[2][column];
    return placement;
}

} // namespace sparselens
