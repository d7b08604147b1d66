// Parts that several test scenes share.
#pragma once

#include "lab/trace/scene.h"

namespace sparselens::lab {

// A lens of 36 mm and a film back 36 mm wide: the picture spans x / z from -1/2 to 1/2.
Camera default_camera(double lens_radius, double focus_distance);

// A floor and a wall under a sky, seen by the default camera with a lens of radius 0.06, focused at 5.
Scene floor_and_wall();

// Thin dark posts near the camera.
void add_fence(Scene &scene);

// A rectangle at depth z that faces the camera and spans these slopes x / z, y / z.
Quad facing(double z, double left, double bottom, double right, double top, Material material);

} // namespace sparselens::lab
