// Converts depth, as renderers write it, to planar depth.
#pragma once

#include "../base/image.h"

#include <Imath/ImathVec.h>

namespace sparselens {

// What the numbers of a depth channel are: planar z, the length of the ray, or 1 / planar z.
enum class DepthMeaning { planar, distance, inverse };

// Whether a depth value stands for the sky: `far` and everything beyond (renderers write 1e10, 1e30, infinity or their
// far clip), and 65504, the largest half, to which such values are clamped. For inverse depth: 1 / far and below.
bool is_sky(DepthMeaning meaning, double value, double far);

// The planar depth of pixel (x, y), EXR coordinates. focal_px (pixels) and the principal point (where the optical axis
// meets the picture, see Camera) are used for ray lengths only. An inverse depth of 0 is infinity.
double planar_depth(DepthMeaning meaning, double value, int x, int y, const Windows &windows, double focal_px,
                    const Imath::V2d &principal_point = {0, 0});

} // namespace sparselens
