// Finds small bright lights in a picture, by brightness alone.
//
// A lamp is a group of pixels. The brightest has more than eight times the median of the block of 16 x 16 pixels around
// it; the others have more than four times that median, and more than a fiftieth of the brightest. Groups larger than
// twelve pixels, and bright pixels beside them, are not lamps.
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
