// How far a candidate is believed: one render makes it, and the other, which shares no noise with it, tests it.
//
// A candidate B of one render replaces the current picture A by A + t (B - A). The share t that fits the other render y
// best is sum w (B - A)(y - A) / sum w (B - A)^2, with w from the tone curve. It is linear in y, so the noise of y
// cannot bias it. But a sum over a few pixels is noisy, and changes that are believed by chance sparkle in a sequence.
// So the sums run over all cells (cells.h) of a class. Two measures of each cell define the classes:
//   - the energy of B - A around it, over the energy of B's noise as shown by the two renders, and
//   - how clearly the renders confirm B - A in a ring around it, in standard deviations. The ring leaves out the
//     cell itself.
#pragma once

#include "finish/evidence.h"

namespace sparselens {

// Combines values made from each render: their mean, weighted by samples.
inline float of_both(const std::array<double, 2> &samples, float first, float second) {
    return float((samples[0] * double(first) + samples[1] * double(second)) / (samples[0] + samples[1]));
}

// Blends a candidate into `pictures` as far as it is believed. `kept`, for each pixel, is multiplied by the share of
// the picture that stays.
void blend_in(Trio &pictures, const Halves &candidate, const RayEvidence &evidence, Values &kept);

} // namespace sparselens
