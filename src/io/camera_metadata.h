// Camera and lens in EXR headers: the standard attributes worldToCamera, worldToNDC, focus (metres), aperture
// (f-number), pinholeFocalLength (mm), and sparselens:* for what has no standard name.
#pragma once

#include "view/camera.h"

#include <ImfHeader.h>

namespace sparselens {

Camera read_camera(const Imf::Header &header);

// Writes what is known, leaves the rest of the header alone.
void write_camera(Imf::Header &header, const Camera &camera);

} // namespace sparselens
