// The work that the selective gather gives to a device: tiles of pixels, and the blocks of splats that each tile
// visits.
#pragma once

#include <Imath/ImathBox.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace sparselens {

struct SplatBlocks;

// A block of splats that can reach a tile.
struct VisitedBlock {
    std::uint32_t block;
    bool covers;   // each of its discs covers the whole tile
    bool ends_bin; // the next block that the tile visits lies in another depth bin
};

struct SplatScene {
    const SplatBlocks &splats;
    Imath::Box2i data; // window
    double pixel_aspect;
    std::size_t layers; // the largest number of layers of a pixel
};

struct SplatTask {
    Imath::Box2i tile;                    // its pixels, in the data window
    std::span<const VisitedBlock> blocks; // front to back
};

// The result of a tile. Its pixels are counted row by row, splat_kernel::size in a row.
struct SplatPicture {
    // Four colours per pixel; the next group of colours follows `group_step` values later.
    const float *values;
    const float *alphas; // one per pixel
    std::size_t group_step;

    float value(std::size_t pixel, std::size_t colour) const {
        return values[colour / 4 * group_step + pixel * 4 + colour % 4];
    }
};

} // namespace sparselens
