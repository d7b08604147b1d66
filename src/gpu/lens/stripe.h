// Tiles that are gathered at once, with their data laid out as lens_tile.comp reads it. A picture whose samples fit
// into no buffer of the device is gathered stripe by stripe: tasks and samples both come row by row, so a stripe needs
// a range of samples.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "kernels/lens_layout.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::gpu {

struct Stripe {
    // Samples: first those of the LDI, then fillers, then solids. Solids have no alphas and no colours.
    std::vector<std::array<float, 2>> places;
    std::vector<std::uint32_t> uppers; // halves of keys
    std::vector<float> cocs, alphas;
    std::vector<float> shown;   // CoCs of what samples show; empty without mirrors and glass: as `cocs`
    std::vector<float> colours; // [group][sample][4]
    std::size_t first_filler = 0;
    std::vector<std::uint32_t> solids;      // the sample that each solid shows
    std::vector<lens_kernel::Block> blocks; // of samples, of fillers, of solids and of facets
    std::vector<std::uint32_t> facets;      // three samples each
    std::vector<std::uint32_t> block_lists, partial_lists;
    std::vector<lens_kernel::Lens> lens;
    // [tile][lens point][two rows]: begin and end of the pixels that see through it
    std::vector<std::uint32_t> columns;
    std::vector<std::uint32_t> holdout;   // of each tile, see place_holdout()
    std::vector<lens_kernel::Tile> tiles; // one per task
    std::vector<std::uint32_t> sets;      // [channel]: its ColourSet
};

// How many of the tasks, from the first, fit into buffers of that many bytes.
std::size_t tasks_that_fit(const GatherScene &scene, std::span<const TileTask> tasks, std::size_t bytes);

// Whether all samples of the scene fit, and the tasks need half of them or more. The positions of samples then do not
// depend on the tasks, so that the next frame of a pull of focus finds them where they were.
bool fits_whole(const GatherScene &scene, std::span<const TileTask> tasks, std::size_t bytes);

// How many turns of the program's loops a lens point of the tile takes; an upper estimate.
double turns_of(const GatherScene &scene, const TileTask &task);

// `whole`: the stripe has all samples of the scene; else those that the tasks need. `most_turns`: in a pass; at least
// turns_of() for each task.
Stripe make_stripe(const GatherScene &scene, std::span<const TileTask> tasks, bool whole, double most_turns);

} // namespace sparselens::gpu
