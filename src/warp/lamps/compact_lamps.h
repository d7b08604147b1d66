// Small bright lights in a picture, told by brightness alone.
//
// A lamp is a group of pixels of which the brightest has more than eight times the median of the block of 16 x 16 pixels
// around it, and the others more than four times that and a fiftieth of the brightest. Groups that are larger than twelve
// pixels, and what is bright beside those, are none.
#pragma once

#include "base/grid.h"

#include <span>
#include <vector>

namespace sparselens {

struct CompactLamp {
    std::vector<Imath::V2i> pixels; // the brightest first
    float limit;                    // all of them are brighter
    float surroundings;             // the median around it
};

// `brightness` of each pixel of the grid, row by row. No two lamps share a pixel.
std::vector<CompactLamp> find_compact_lamps(const Grid &grid, std::span<const float> brightness);

} // namespace sparselens
