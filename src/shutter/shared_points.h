// Divides a set of lens points between the moments of a shutter.
//
// The shares of all moments together are the set that a still takes, so that a scene that stands still looks like the
// still. The points of each share are spread over the lens and over the pixel, so that each moment shows whole discs.
#pragma once

#include "lens/lens_samples.h"
#include "shutter/lens_share.h"

#include <vector>

namespace sparselens {

// The points of one moment, in their order. Shares differ by one point at most. If there are fewer points than moments,
// several moments take the same point.
std::vector<LensSample> shared_points(std::vector<LensSample> points, const LensShare &share);

} // namespace sparselens
