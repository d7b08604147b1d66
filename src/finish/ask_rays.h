// Says where more rays are needed: in each pixel, and in a few rectangles, which renderers can render by themselves.
//
// The error of a block falls as a power of its rays (fall_of()). So it is least if rays go as the error of one ray to
// the power 1 / (1 + fall). Rays that are there are not taken away.
#pragma once

#include "finish/finish_picture.h"

#include <Imath/ImathBox.h>

#include <utility>
#include <vector>

namespace sparselens {

struct AskedRays {
    Values more; // samples that each pixel needs beyond those that it has
    // A few rectangles that need about as many rays together: pixels of the grid, and an even number of samples.
    std::vector<std::pair<Imath::Box2i, int>> rectangles;
};

// `rays`: for each pixel on average, with those that it has; 0: as many as a mean squared error of `goal` takes.
AskedRays ask_rays(const ErrorEstimate &error, const RayCounts &samples, const Grid &grid, double rays,
                   double goal = 0);

} // namespace sparselens
