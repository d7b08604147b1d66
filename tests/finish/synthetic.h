// Pictures with known truth, and noisy renders of them: a slope, texture, edges and a lamp, with the noise of a chosen
// number of rays.
#pragma once

#include "finish/finish.h"

#include <cstdint>

namespace sparselens {

// A picture of `width` x `height` pixels with three channels. Each `variant` is another scene.
Colours synthetic_truth(const ArrayGrid &grid, int variant = 0);

// The mean of `samples` rays per pixel. Each ray has a relative standard deviation of 1/2, plus a tenth of that of
// white.
Colours rays_of(const Colours &truth, double samples, std::uint32_t seed);

// Both renders of a scene, and the gathered picture.
LayerToFinish layer_of(const ArrayGrid &grid, const Colours &truth, Colours gathered,
                       const std::array<double, 2> &samples, std::uint32_t seed = 1);

// The mean, weighted by samples.
Colours mean_of(const Halves &rays, const std::array<double, 2> &samples);

// The value that dof-compare prints as psnr_tonemapped.
double decibels_of(const Colours &picture, const Colours &truth);

// The mean over a square of side 2 radius + 1: an inaccurate gathered picture.
Colours blurred(Colours colours, const ArrayGrid &grid, int radius);

FinishedLayer finished(const LayerToFinish &layer);

} // namespace sparselens
