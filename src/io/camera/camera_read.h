// Camera and lens as EXR headers have them: the standard attributes worldToCamera, worldToNDC, focus (metres), aperture
// (f-number), pinholeFocalLength (mm), sparselens:* for what has no standard name, and what other programs write.
#pragma once

#include "../../view/camera.h"

#include <Imath/ImathBox.h>
#include <ImfHeader.h>

namespace sparselens {

// By the standard's attributes and those of other programs (camera_attributes.h); where sparselens:version stands,
// by ours alone. What is missing, no number or out of range, or said twice and differently, is unknown, and why is
// noted (Camera::unsure). worldToNDC comes in the standard's convention, whatever the file's.
Camera read_camera(const Imf::Header &header);

// Of an LDI whose data window has grown beyond that of its centre view: the centre view's data window, which is
// that of the pictures made from it. Else the header's own.
Imath::Box2i read_picture_window(const Imf::Header &header);

} // namespace sparselens
