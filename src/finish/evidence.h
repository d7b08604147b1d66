// The evidence of two independent renders about a candidate, cell by cell (cells.h): how much it changes, how much of
// the change the other render confirms, which did not make it, and how much is noise.
#pragma once

#include "finish/cells.h"

namespace sparselens {

// Two independent renders of the same pixels.
struct RayEvidence {
    const Halves &rays;
    std::array<double, 2> samples; // per pixel, > 0: how much each render counts
    Grid grid;
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
    // How much light a bright event brings to one sample: the variance over the mean, as for Poisson-distributed
    // events, of all light that the rays show above the picture. Light that both renders show alike is not an event,
    // and adds only to the mean.
    double event_height = 0;
};

CellEvidence evidence_of(const Trio &pictures, const Halves &candidate, const RayEvidence &evidence,
                         const Cells &cells);

} // namespace sparselens
