// Camera and lens in EXR headers: the standard attributes worldToCamera, worldToNDC, focus (metres), aperture
// (f-number), pinholeFocalLength (mm), and sparselens:* for what has no standard name.
#pragma once

#include "view/camera.h"

#include <ImfHeader.h>

namespace sparselens {

// What is missing, of another type, no number or out of range is unknown (see Camera).
Camera read_camera(const Imf::Header &header);

// Writes what is known (and sparselens:version), leaves the rest of the header alone.
void write_camera(Imf::Header &header, const Camera &camera);

} // namespace sparselens
