// How far a candidate is to be believed: one render makes it, the other, which shares no noise with it, tests it.
//
// A candidate B of one render replaces the picture A so far by A + t (B - A). The share t that fits the other render y best is
// sum w (B - A)(y - A) / sum w (B - A)^2, w by the tone curve. It is linear in y, so the noise of y cannot bias it. A sum over a
// few pixels is noisy, though, and what is believed by chance sparkles in a sequence. So the sums run over all cells (cells.h) of
// a class, and classes are made of two measures that each cell has:
//   - the energy of B - A around it over that of B's noise, as the two renders differ, and
//   - how surely the renders confirm B - A in a ring around it, in standard deviations. The ring leaves out the cell itself.
#pragma once

#include "finish/evidence.h"

namespace sparselens {

// What both renders together make of what each made: their mean by samples.
inline float of_both(const std::array<double, 2> &samples, float first, float second) {
    return float((samples[0] * double(first) + samples[1] * double(second)) / (samples[0] + samples[1]));
}

// Blends a candidate into `pictures` as far as it is to be believed. `kept`, for each pixel, is multiplied by the share of the
// picture that stays.
void blend_in(Trio &pictures, const Halves &candidate, const RayEvidence &evidence, Values &kept);

} // namespace sparselens
