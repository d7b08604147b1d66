// Camera and lens in EXR headers: the standard attributes worldToCamera, worldToNDC, focus (metres), aperture
// (f-number), pinholeFocalLength (mm), and sparselens:* for what has no standard name.
#pragma once

#include "../../view/camera.h"

#include <ImfHeader.h>

namespace sparselens {

// By the standard's attributes and those of other programs (camera_attributes.h); where sparselens:version stands,
// by ours alone. What is missing, no number or out of range, or said twice and differently, is unknown, and why is
// noted (Camera::unsure). worldToNDC comes in the standard's convention, whatever the file's.
Camera read_camera(const Imf::Header &header);

// Writes what is known (and sparselens:version), leaves the rest of the header alone.
void write_camera(Imf::Header &header, const Camera &camera);

// Of an LDI whose data window has grown beyond that of its centre view: the centre view's data window, which is
// that of the pictures made from it. Else the header's own.
Imath::Box2i read_picture_window(const Imf::Header &header);
void write_picture_window(Imf::Header &header, const Imath::Box2i &window);

} // namespace sparselens
