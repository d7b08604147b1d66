// Camera and lens into EXR headers, as camera_read.h reads them.
#pragma once

#include "../../view/camera.h"

#include <Imath/ImathBox.h>
#include <ImfHeader.h>

namespace sparselens {

// Writes what is known (and sparselens:version), leaves the rest of the header alone.
void write_camera(Imf::Header &header, const Camera &camera);

// The data window of the pictures made from an LDI (see read_picture_window).
void write_picture_window(Imf::Header &header, const Imath::Box2i &window);

} // namespace sparselens
