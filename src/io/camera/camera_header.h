// Reads the camera and the lens from EXR headers: the standard attributes worldToCamera, worldToNDC, focus (metres),
// aperture (f-number) and pinholeFocalLength (mm), sparselens:* for values without a standard name, and the attributes
// of other programs.
#pragma once

#include "../../view/view.h"

#include <Imath/ImathBox.h>
#include <ImfHeader.h>

#include <string>

namespace sparselens {

// Reads the standard attributes and those of other programs (camera_attributes.h), or only ours if the header has
// sparselens:version. A value that is missing, invalid, out of range or contradictory is unknown; the reason is in
// Camera::unsure. worldToNDC is converted to the convention of the standard.
Camera read_camera(const Imf::Header &header);

// The same for a picture that is seen through a lens, which requires a perspective camera. Throws Error, naming the
// file and the attribute, if the header states another camera: orthographic, or a panorama.
Camera read_perspective_camera(const Imf::Header &header, const std::string &name);

// The data window of pictures made from an LDI. The LDI may have grown beyond its centre view; the pictures have the
// data window of the centre view. For other files: the data window of the header.
Imath::Box2i read_picture_window(const Imf::Header &header);

// Writes the values that are known, and sparselens:version. The rest of the header is left alone.
void write_camera(Imf::Header &header, const Camera &camera);

// The same for a picture taken by a lens: it has no sub-pixels, and its data window is its own.
void write_picture_camera(Imf::Header &header, Camera camera);

// Writes the data window of the pictures that are made from an LDI (see read_picture_window).
void write_picture_window(Imf::Header &header, const Imath::Box2i &window);

} // namespace sparselens
