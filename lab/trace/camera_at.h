// The cameras of views from points of the lens.
#pragma once

#include "base/image.h"
#include "lab/trace/motion.h"
#include "view/view.h"

namespace sparselens::lab {

// `camera`, moved by `offset` (scene units, x right, y up) in its own plane, with the matrices of the new position; the
// world is the space of the centre view's camera at rest. The focal length and the sensor width must be known.
Camera camera_at(const Camera &camera, const Windows &windows, const Imath::V2d &offset,
                 const Placement &placement = {{}, 0});

} // namespace sparselens::lab
