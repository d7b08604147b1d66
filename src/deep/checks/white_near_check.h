// Whether depths from 0 to 1 are normalised with 1 near the camera, but read as planar depths.
//
// Along a plane that recedes, 1 / z is linear across the picture. So z grows faster and faster with the distance, and a
// number that falls linearly with z falls faster and faster.
#pragma once

#include "base/grid.h"

#include <cstddef>
#include <span>

namespace sparselens {

struct DepthBends {
    std::size_t slopes = 0; // places where a surface recedes smoothly
    double upward = 0;      // the share of them that bend as planar depths do
    double downward = 0;    // the share of them that bend the other way
};

DepthBends bends_of_depth(const Grid &grid, std::span<const float> depths);

// Whether no depth is above 1, and the slopes bend downward.
bool looks_white_near(const Grid &grid, std::span<const float> depths);

} // namespace sparselens
