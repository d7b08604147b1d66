// The cameras that take the centre view and the views of a plan, in numbers that a person or a script can give to any
// renderer. All cameras look in the same direction as the centre camera and have its screen window.
#pragma once

#include "plan/plan.h"
#include "view/camera.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// The part of the plane at depth 1 that the display window shows, as in OpenEXR: its width, and its centre relative to
// the optical axis; x right, y up.
struct ScreenWindow {
    double width = 1; // (0, inf)
    Imath::V2d centre{0, 0};
};

struct PlannedCamera {
    std::string name;                           // center, view_0, ...
    Imath::V2d offset{0, 0};                    // from the centre camera, scene units, x right, y up
    std::optional<Imath::M44d> world_to_camera; // as in Camera; empty if the centre's is unknown
};

struct PlannedCameras {
    ScreenWindow window;
    std::vector<PlannedCamera> cameras; // the centre camera first
};

// `camera` and `lens` are the centre view's, `display_width` is its width in pixels.
PlannedCameras cameras_of(const Plan &plan, const Camera &camera, const ThinLens &lens, int display_width);

// The placement of a camera that looks along -z, as in Maya, Houdini, USD and Blender: x right, y up. The rows are the
// axes and the position in world space.
Imath::M44d camera_to_world_looking_back(const Imath::M44d &world_to_camera);

} // namespace sparselens
