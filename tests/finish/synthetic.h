// Pictures and renders of it whose truth is known: a slope, texture, edges and a lamp, and noise of a chosen number of rays.
#pragma once

#include "finish/finish.h"

#include <cstdint>

namespace sparselens {

// Of `width` x `height` pixels and three channels. Another `variant` is another scene.
Colours synthetic_truth(const Grid &grid, int variant = 0);

// The mean of `samples` rays a pixel: each has a relative standard deviation of 1/2, and a tenth of that of white.
Colours rays_of(const Colours &truth, double samples, std::uint32_t seed);

// Both renders of a scene, and what was gathered.
LayerToFinish layer_of(const Grid &grid, const Colours &truth, Colours gathered,
                       const std::array<double, 2> &samples, std::uint32_t seed = 1);

// The mean by samples.
Colours mean_of(const Halves &rays, const std::array<double, 2> &samples);

// As dof-compare prints it: psnr_tonemapped.
double decibels_of(const Colours &picture, const Colours &truth);

// Averaged over a square of side 2 radius + 1: a gathered picture that is wrong.
Colours blurred(Colours colours, const Grid &grid, int radius);

FinishedLayer finished(const LayerToFinish &layer);

} // namespace sparselens
