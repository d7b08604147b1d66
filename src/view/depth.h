// Depth as renderers write it, made planar.
#pragma once

#include "../base/image.h"

#include <Imath/ImathVec.h>

namespace sparselens {

// What the numbers of a depth channel are: planar z, the length of the ray, or 1 / planar z.
enum class DepthMeaning { planar, distance, inverse };

// Whether a renderer that writes such a value means the sky: `far` and beyond (as 1e10, 1e30, infinity, or the far clip
// where the caller knows it), and 65504, which is what the largest half makes of them; of inverse depth 1 / far and
// below.
bool is_sky(DepthMeaning meaning, double value, double far);

// Planar depth of pixel (x, y), EXR coordinates. focal_px (pixels) and the principal point (where the optical axis
// meets the picture, see Camera) matter for ray lengths only. An inverse depth of 0 is infinity.
double planar_depth(DepthMeaning meaning, double value, int x, int y, const Windows &windows, double focal_px,
                    const Imath::V2d &principal_point = {0, 0});

} // namespace sparselens
