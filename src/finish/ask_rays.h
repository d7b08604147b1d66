// Says where more rays are needed: in each pixel, and in a few rectangles, which renderers can render by themselves.
//
// The error of a block falls as a power of its rays (fall_of()). So the whole error is least if each block has rays in
// proportion to its error with one ray, to the power 1 / (1 + fall). No block gets fewer rays than it has.
#pragma once

#include "base/grid.h"
#include "finish/error_estimate.h"

#include <Imath/ImathBox.h>

#include <utility>
#include <vector>

namespace sparselens {

struct AskedRays {
    Values more; // samples that each pixel needs beyond those that it has
    // A few rectangles that need about as many rays together: pixels of the grid, and an even number of samples.
    std::vector<std::pair<Imath::Box2i, int>> rectangles;
};

// `rays`: for each pixel of `pixels` on average, with those that it has; 0: as many as a mean squared error of `goal` takes.
// `pixels`: the pixels of the grid that may need rays.
AskedRays ask_rays(const ErrorEstimate &error, const RayCounts &samples, const Grid &grid,
                   const Imath::Box2i &pixels, double rays, double goal = 0);

} // namespace sparselens
