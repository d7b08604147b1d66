// What the selective gather asks of a device: tiles of pixels, and the blocks of splats that each visits.
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
    bool covers;   // the whole tile with each of its discs
    bool ends_bin; // the next one that the tile visits lies in another bin of depth
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

// What a tile has gathered. Its pixels are counted row by row, splat_kernel::size a row.
struct SplatPicture {
    const float *values; // four colours of each pixel, those of the next group `group_step` values later
    const float *alphas; // of each pixel
    std::size_t group_step;

    float value(std::size_t pixel, std::size_t colour) const {
        return values[colour / 4 * group_step + pixel * 4 + colour % 4];
    }
};

} // namespace sparselens
