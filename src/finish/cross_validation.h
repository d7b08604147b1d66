// How far a candidate is accepted: one render makes it, and the other, which shares no noise with it, tests it.
//
// A candidate B of one render replaces the current picture A by A + t (B - A). The share t that fits the other render y
// best is sum w (B - A)(y - A) / sum w (B - A)^2, with w from the tone curve. It is linear in y, so the noise of y
// cannot bias it. But a sum over a few pixels is noisy, and changes that are accepted by chance sparkle in a sequence.
// So the sums run over all cells (window_means.h) of a class. Two measures of each cell define the classes:
//   - the energy of B - A around it, over the energy of B's noise as shown by the two renders, and
//   - how clearly the renders confirm B - A in a ring around it, in standard deviations. The ring leaves out the
//     cell itself.
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
};

// Pictures made of the first render, of the second, and of both. The third is the result; the others test it.
using Trio = std::array<Colours, 3>;

// Means over the pixels of each cell, of sums over channels weighted by the tone curve. B is a candidate, A the current
// picture, and y the render that tests it.
struct CellEvidence {
    std::array<Values, 3> energy;    // (B - A)^2
    std::array<Values, 2> confirmed; // (B - A)(y - A)
    std::array<Values, 2> left;      // ((B - A)(y - B))^2
    std::array<Values, 2>
        removed;   // (B - A)^2 times the light that B takes away, for the variance of such light
    Values spread; // the squared difference between the changes by both renders
    Values noise;  // squared difference of the renders
    std::array<Values, 2> samples; // of each render
    // How much light a bright event brings to one sample: the variance over the mean, as for Poisson-distributed
    // events, of all light that the rays show above the picture. Light that both renders show alike is not an event,
    // and adds only to the mean.
    double event_height = 0;
};

CellEvidence evidence_of(const Trio &pictures, const Halves &candidate, const RayEvidence &evidence,
                         const Cells &cells);

// The cells that share one degree of belief in a candidate: those of a class, or all cells of the picture.
enum class Among { classes, whole_picture };

// Blends a candidate into `pictures` as far as it is accepted. `kept`, for each pixel, is multiplied by the share of
// the picture that stays.
void blend_in(Trio &pictures, const Halves &candidate, const RayEvidence &evidence, Values &kept,
              Among among = Among::classes);

} // namespace sparselens
