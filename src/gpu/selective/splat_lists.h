// The lists of splats that tiles of the selective gather visit, in the layout that selective_tile.comp reads.
//
// The list of a tile is cut into passes. Each takes a limited number of steps, which are turns of the program's loops,
// because operating systems end work that takes seconds. A tile that is done sooner has empty passes at the end.
#pragma once

#include "dof/device/tile_device.h"
#include "kernels/layer_rules.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::gpu {

// Blocks of splats, cut into pieces.
struct SplatPieces {
    std::vector<splat_kernel::Piece> pieces;
    std::vector<std::uint32_t> first; // of each block; one more is the end
};

struct SplatLists {
    std::vector<std::uint32_t> pieces; // their numbers times 4, with the bits of the shader
    std::vector<std::uint32_t> cuts;   // [tile][pass]: where it begins in the pieces; one more is the end
    std::vector<splat_kernel::Tile> tiles;
    std::size_t passes = 0;
    double steps = 0; // of any tile in a pass, at most
};

// The sizes, in numbers, of what stays on the device between passes.
struct SplatState {
    std::size_t layers, gaps, states, running;
};
SplatState state_of(const SplatScene &scene, std::size_t tiles);

SplatPieces cut(const SplatBlocks &splats);
std::size_t groups_of(const SplatBlocks &splats); // of four colours

// `most_steps`: the largest number of steps of a tile in a pass. A single piece may take more.
SplatLists lists_of(const SplatScene &scene, const SplatPieces &pieces, std::span<const SplatTask> tasks,
                    double most_steps);

} // namespace sparselens::gpu
