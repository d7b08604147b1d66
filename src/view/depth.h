// Depth as renderers write it, made planar.
#pragma once

#include "base/image.h"

namespace sparselens {

// What the numbers of a depth channel are: planar z, the length of the ray, or 1 / planar z.
enum class DepthMeaning { planar, distance, inverse };

// Planar depth of pixel (x, y), EXR coordinates. The optical axis goes through the display window's middle;
// focal_px (pixels) matters for ray lengths only. An inverse depth of 0 is infinity.
double planar_depth(DepthMeaning meaning, double value, int x, int y, const Windows &windows,
                    double focal_px);

} // namespace sparselens
