// The procedural materials of the test scenes: functions of the position alone.
#pragma once

#include "lab/trace/scene.h"

namespace sparselens::lab {

// Pseudo-random number in [0, 1) of three integers; its bits are part of the scenes' definition.
double hash(int a, int b, int c);

Paint floor_tiles(const Imath::V3d &position);
Paint wall_tiles(const Imath::V3d &position);
Paint dots(const Imath::V3d &position);
Paint stripes(const Imath::V3d &position);
Paint dark(const Imath::V3d &position);
Paint lamp(const Imath::V3d &position); // radiance (60, 48, 30)

// Of the scene "slant": tiles that look equally large from the origin wherever they lie, so that detail stays the
// same while blur changes, and none is finer than a pixel.
Paint even_tiles(const Imath::V3d &position);

// Of the scene "lamps": radiance 1000; radiance (0.02, 0.02, 0.025).
Paint bright_lamp(const Imath::V3d &position);
Paint night(const Imath::V3d &position);

// Of the scene "mirror": what it shows depends on where it is seen from.
Paint chrome(const Imath::V3d &position);

// Of the scene "mist": all emit; the sheets cover in part.
Paint near_sheet(const Imath::V3d &position);
Paint focus_sheet(const Imath::V3d &position);
Paint far_sheet(const Imath::V3d &position);
Paint backdrop(const Imath::V3d &position);

} // namespace sparselens::lab
