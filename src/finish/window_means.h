// Means over windows around each pixel of a plane. Only the part of a window inside the picture counts, so a constant
// plane stays constant.
#pragma once

#include "base/grid.h"

#include <span>

namespace sparselens {

// The mean over a square of side 2 radius + 1, in place. `values` holds a value for each pixel of `grid`; radius >= 0.
void box_mean(std::span<float> values, const Grid &grid, int radius);

// Three box means in succession, in place: nearly a Gaussian of standard deviation sqrt(radius (radius + 1)), by the
// central limit theorem.
void soft_mean(std::span<float> values, const Grid &grid, int radius);

} // namespace sparselens
