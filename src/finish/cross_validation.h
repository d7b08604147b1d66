// How far a candidate is accepted: one render makes it, and the other, which shares no noise with it, tests it.
//
// A candidate B of one render replaces the current picture A by A + t (B - A). The share t that fits the other render y
// best is sum w (B - A)(y - A) / sum w (B - A)^2, with w from the tone curve. It is linear in y, so the noise of y
// cannot bias it. But a sum over a few pixels is noisy, and changes that are accepted by chance sparkle in a sequence.
// So the sums run over squares of several sizes around each place, and the share of a larger square, or of the whole
// picture, is moved towards that of a smaller one only as far as its own variance proves it (W. James, C. Stein, 1961).
// The variance is that of the products themselves: one bright event that both renders happen to show proves nothing.
// Light that a candidate takes away counts as if rays could have missed it. Noise that it adds to the picture costs more
// than other errors, and noise that it takes away counts for as much.
// The picture of both renders has less noise than the picture of one, so it takes a share of its own. With five views,
// this gains .3 dB on hair and .6 dB on lamps outside the frame for 64 + 16 rays, and .6 and 1 dB for 256 + 64 rays.
#pragma once

#include "finish/window_means.h"

namespace sparselens {

// The evidence of two independent renders about a candidate, cell by cell: how much it changes, how much of the change
// is confirmed by the render that did not make it, and how much is noise.

// Two independent renders of the same pixels.
struct RayEvidence {
    const Halves &rays;
    const RayCounts &samples;
    ArrayGrid grid;
    float exposure = 1; // of values, for the tone curve
};

// Pictures made of the first render, of the second, and of both. The third is the result; the others test it.
using Trio = std::array<Colours, 3>;

// Means over the pixels of each cell, of sums over channels weighted by the tone curve. B is a candidate, A the current
// picture, and y the render that tests it.
struct CellEvidence {
    std::array<Values, 3> energy;    // (B - A)^2
    std::array<Values, 2> confirmed; // (B - A)(y - A)
    std::array<Values, 2> squares;   // of `confirmed` in each pixel
    // (B - A)^2 times the light that B takes away, for the variance of such light
    std::array<Values, 2> removed;
    Values spread; // the squared difference between the changes by both renders
    // The same difference times that between the pictures: below 0 where the change takes noise away.
    Values shared;
    std::array<Values, 2> samples; // of each render
    // How much light a bright event brings to one sample: the variance over the mean, as for Poisson-distributed
    // events, of all light that the rays show above the picture. Light that both renders show alike is not an event,
    // and adds only to the mean.
    double event_height = 0;
};

CellEvidence evidence_of(const Trio &pictures, const Halves &candidate, const RayEvidence &evidence,
                         const Cells &cells);

// Blends a candidate into `pictures` as far as it is accepted. `kept`, for each pixel, is multiplied by the share of
// the picture that stays.
void blend_in(Trio &pictures, const Halves &candidate, const RayEvidence &evidence, Values &kept);

} // namespace sparselens
