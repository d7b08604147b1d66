// The procedural materials of the test scenes: functions of the position alone.
#pragma once

#include "trace/scene.h"

namespace sparselens {

// Pseudo-random number in [0, 1) of three integers; its bits are part of the scenes' definition.
double hash(int a, int b, int c);

Paint floor_tiles(const Imath::V3d &position);
Paint wall_tiles(const Imath::V3d &position);
Paint dots(const Imath::V3d &position);
Paint stripes(const Imath::V3d &position);
Paint dark(const Imath::V3d &position);
Paint lamp(const Imath::V3d &position); // radiance (60, 48, 30)

} // namespace sparselens
