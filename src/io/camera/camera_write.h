// Writes the camera and the lens into EXR headers, as camera_read.h reads them.
#pragma once

#include "../../view/camera.h"

#include <Imath/ImathBox.h>
#include <ImfHeader.h>

namespace sparselens {

// Writes the values that are known, and sparselens:version. The rest of the header is left alone.
void write_camera(Imf::Header &header, const Camera &camera);

// The same for a picture taken by a lens: it has no sub-pixels, and its data window is its own.
void write_picture_camera(Imf::Header &header, Camera camera);

// Writes the data window of the pictures that are made from an LDI (see read_picture_window).
void write_picture_window(Imf::Header &header, const Imath::Box2i &window);

} // namespace sparselens
