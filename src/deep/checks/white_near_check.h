// Whether depths from 0 to 1 are normalised with 1 near the camera, and read as planar ones.
//
// Along a plane that recedes, 1 / z is linear across the picture: so z grows faster and faster with the distance, and a number
// that falls linearly with z falls faster and faster.
#pragma once

#include "base/grid.h"

#include <cstddef>
#include <span>

namespace sparselens {

struct DepthBends {
    std::size_t slopes = 0; // places where a surface recedes smoothly
    double upward = 0;      // the share of them that bend as planar depths do
    double downward = 0;    // the share that bends the other way
};

DepthBends bends_of_depth(const Grid &grid, std::span<const float> depths);

// Whether none is above 1, and they bend downward.
bool looks_white_near(const Grid &grid, std::span<const float> depths);

} // namespace sparselens
