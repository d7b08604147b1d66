// The lists that a group of tiles is gathered from, in the layout that lens_tile.comp reads.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "kernels/lens_rules.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::gpu {

inline constexpr std::size_t tile_pixels = lens_kernel::tile_size * lens_kernel::tile_size;

struct TileLists {
    std::vector<std::uint32_t> blocks;  // SceneArrays::blocks; and runs of numbers (kernels/lens_rules.h)
    std::vector<std::uint32_t> partial; // samples of partial coverage
    std::vector<lens_kernel::Lens> lens;
    // [tile][lens point][two rows]: begin and end of the pixels that see through it past a cat-eye
    std::vector<std::uint32_t> columns;
    // [tile]: for each pixel, the index of its first part of the tile's holdout; then the number of all parts; then for
    // each part front, back and the share of light that it lets through (bits of float). Empty without a holdout.
    std::vector<std::uint32_t> holdout;
    std::vector<lens_kernel::Tile> tiles; // one per task
    std::uint32_t passes = 1;
};

// How many turns of the program's loops some lens points, taken at once, of the tile take; an upper estimate.
double turns_of(const GatherScene &scene, const TileTask &task);

// The lens points of each task are taken `points` at a time, in passes, because operating systems end work that takes
// seconds. `most_turns`: the largest number of a work group in a pass; at least turns_of() for each task.
TileLists lists_of(const GatherScene &scene, std::span<const TileTask> tasks, std::uint32_t points,
                   double most_turns);

// Returns the rules of lens_rules.h that any of the tasks needs.
std::uint32_t rules_of(const GatherScene &scene, std::span<const TileTask> tasks);

} // namespace sparselens::gpu
