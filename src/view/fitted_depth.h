// The depth of a picture that has fewer pixels than the picture, as phones and estimators give it.
//
// Each value of the depth belongs to a cell of the frame. A pixel takes the median of what the 5 x 5 cells around it say,
// so an edge of the depth moves to the edge of the colours, at most two cells away. The weight of a cell in the median is
//
//     exp(-d^2 / 2) (1 - m / 2) / (1 + c^2 / 2 s^2)^2
//
// with d, the distance of its middle from the pixel, in cells; m, from 0 to 1, which tells how far its depth lies between
// the least and the largest one of the 3 x 3 cells around it, as that of a cell that mixes two surfaces; c, the difference
// of its mean colour from that of the pixel; and s^2, the mean variance of the colours within a cell, over the 3 x 3 cells
// around the pixel. Because s follows from the picture, exposure does not matter. A cell gives the depth of a plane through
// its own depth. The slopes of this plane are the smaller ones of those to the neighbours on both sides, so a plane stays
// a plane, and no depth overshoots.
#pragma once

#include "base/grid.h"
#include "base/image.h"

#include <span>
#include <vector>

namespace sparselens {

// Returns a depth for each pixel of the data window. `cells` divide the display window; pixels beyond it are treated as
// those of its border. A cell that is NaN says nothing; a pixel around which all are NaN becomes NaN. If the cells are
// not larger than pixels, the pixel takes the depth of the cell in its middle.
std::vector<float> fit_depth(const Image &picture, const ArrayGrid &cells, std::span<const float> depths);

} // namespace sparselens
