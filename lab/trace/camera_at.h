// The cameras of views from points of the lens.
#pragma once

#include "base/image.h"
#include "view/camera.h"

namespace sparselens::lab {

// `camera`, moved by `offset` (scene units, x right, y up) in its own plane, with the matrices of the new position; the
// world is the camera space of the centre view. The focal length and the sensor width must be known.
Camera camera_at(const Camera &camera, const Windows &windows, const Imath::V2d &offset);

} // namespace sparselens::lab
