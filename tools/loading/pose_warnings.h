// What ldi-warp says of views whose stated positions cannot be right.
#pragma once

#include "harness/tool.h"
#include "view/view.h"

#include <span>

namespace sparselens {

// One line on stderr for each finding of pose_check.h. views[0] is the centre; `focal_px` is the focal length in pixels,
// `lens_radius` that of the lens, scene units, 0 if unknown.
void warn_of_wrong_poses(const ToolContext &tool, std::span<const View> views, double focal_px,
                         double lens_radius);

} // namespace sparselens
