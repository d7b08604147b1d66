// The procedural materials of the test scenes: functions of the position alone.
#pragma once

#include "lab/trace/scene.h"

namespace sparselens::lab {

// A pseudo-random number in [0, 1) from three integers; its bits are part of the definition of the scenes.
double hash(int a, int b, int c);

Paint floor_tiles(const Imath::V3d &position);
Paint wall_tiles(const Imath::V3d &position);
Paint dots(const Imath::V3d &position);
Paint stripes(const Imath::V3d &position);
Paint dark(const Imath::V3d &position);
Paint lamp(const Imath::V3d &position); // radiance (60, 48, 30)

// For the scene "slant": tiles that have the same apparent size from the origin wherever they are, so that the detail
// stays the same while the blur changes, and no tile is finer than a pixel.
Paint even_tiles(const Imath::V3d &position);

// For the scene "lamps": radiance 1000; radiance (0.02, 0.02, 0.025).
Paint bright_lamp(const Imath::V3d &position);
Paint night(const Imath::V3d &position);

// For the scene "mirror": the colour depends on the direction of view.
Paint chrome(const Imath::V3d &position);

// For the scenes of mirrors and glass. Glass is `glass_thickness` thick and refracts by `refractive_index`.
inline constexpr double glass_thickness = 3, refractive_index = 1.5;
Paint silver(const Imath::V3d &position);       // a perfect mirror
Paint brushed(const Imath::V3d &position);      // a rough mirror
Paint clear_glass(const Imath::V3d &position);  // lets all light through
Paint glossy_tiles(const Imath::V3d &position); // floor_tiles under a varnish
Paint mosaic(const Imath::V3d &position);       // tiles of many sizes and colours, all different

// For the scene "mist": all materials emit; the sheets have partial coverage.
Paint near_sheet(const Imath::V3d &position);
Paint focus_sheet(const Imath::V3d &position);
Paint far_sheet(const Imath::V3d &position);
Paint backdrop(const Imath::V3d &position);

// For the scene "macro": freckles some millimetres wide; radiance 200.
Paint skin(const Imath::V3d &position);
Paint head_lamp(const Imath::V3d &position);

} // namespace sparselens::lab
