// The splats of the selective gather, and tiles of it that a device takes at once, as selective_tile.comp reads them.
//
// The list of a tile is cut into passes. Each pass takes a limited number of steps, because devices end work that takes
// long. A tile that is done sooner has empty passes at the end.
#pragma once

#include "dof/device/tile_device.h"
#include "kernels/layer_rules.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::gpu {

// The splats from which all tiles are gathered.
struct SplatArrays {
    std::size_t groups = 0;     // of four colours
    std::vector<double> discs;  // [splat]: x, y, radius
    std::vector<float> shares;  // [splat]: coverage, known, known times radius
    std::vector<float> colours; // [group][splat][4]
    std::vector<splat_kernel::Piece> pieces;
    std::vector<double> sums;               // [block][group][splat_kernel::bin_sums]
    std::vector<std::uint32_t> first_piece; // of each block; one more is the end
};

struct SplatLists {
    std::vector<std::uint32_t> pieces; // their numbers times 4, with the bits of the shader
    std::vector<std::uint32_t> cuts;   // [tile][pass]: where it begins in the pieces; one more is the end
    std::vector<splat_kernel::Tile> tiles;
    std::vector<double> steps; // of a tile in a pass, at most
    std::size_t passes = 0;
};

// The sizes, in numbers, of what stays on the device between passes.
struct SplatState {
    std::size_t layers, gaps, states, running;
};
SplatState state_of(const SplatScene &scene, std::size_t tiles);

SplatArrays arrays_of(const SplatBlocks &splats);
std::size_t largest_array(const SplatBlocks &splats); // bytes

// How many of the tasks, from the first, fit into buffers of that many bytes.
std::size_t tasks_that_fit(const SplatScene &scene, std::span<const SplatTask> tasks, std::size_t bytes);

// `steps`: the turns of the program's loops that a pass may take.
SplatLists lists_of(const SplatScene &scene, const SplatArrays &arrays, std::span<const SplatTask> tasks,
                    double steps);

} // namespace sparselens::gpu
