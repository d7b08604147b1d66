// Tiles that are gathered at once, with their data laid out as lens_tile.comp reads it. A picture whose samples fit
// into no buffer of the device is gathered stripe by stripe: tasks and samples both come row by row, so a stripe needs
// a range of samples.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/sample_blocks.h"
#include "kernels/lens_rules.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::gpu {

struct Stripe {
    // Samples: first those of the LDI, then fillers, then solids. Solids have no alphas and no colours.
    std::vector<std::array<float, 2>> places;
    std::vector<std::uint32_t> uppers; // halves of keys, with lens_kernel::hiding except for fillers
    std::vector<float> cocs, alphas;
    std::vector<float> shown;   // CoCs of what samples show; empty without mirrors and glass: as `cocs`
    std::vector<float> colours; // [group][sample][4]
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

// How many turns of the program's loops some lens points, taken at once, of the tile take; an upper estimate.
double turns_of(const GatherScene &scene, const TileTask &task);

// `whole`: the stripe has all samples of the scene; else those that the tasks need. The lens points of each task are
// taken `points` at a time. `most_turns`: in a pass; at least turns_of() for each task.
Stripe make_stripe(const GatherScene &scene, std::span<const TileTask> tasks, bool whole,
                   std::uint32_t points, double most_turns);

// The rules by which a tile is gathered on a device, and what these rules look up for each of its pixels: which lens
// points it sees through past a cat-eye, and what a holdout lets through there; and for its quarters, their samples of
// partial coverage.
inline constexpr std::size_t tile_pixels = lens_kernel::tile_size * lens_kernel::tile_size;

// Returns the rules of lens_rules.h that any of the tasks needs.
std::uint32_t rules_of(const GatherScene &scene, std::span<const TileTask> tasks);

// [lens point][two rows]: where the pixels of a row that see through the lens point begin and end, 8 bits each. Empty
// without a cat-eye.
std::size_t column_words(const GatherScene &scene, const TileTask &task);
void place_columns(std::span<std::uint32_t> to, const GatherScene &scene, const TileTask &task);

// For each pixel, the index of its first part of the tile's holdout; then the number of all parts; then for each part
// front, back and the share that it lets through (bits of float). Empty without a holdout.
std::size_t holdout_words(const GatherScene &scene, const TileTask &task);
void place_holdout(std::span<std::uint32_t> to, const GatherScene &scene, const TileTask &task);

// Lists of the samples of partial coverage that a tile's lens points can bring into each of its quarters: front to
// back, and in ascending order where depths are equal.
using PartialLists = std::array<std::vector<std::uint32_t>, lens_kernel::quarters>;

PartialLists partial_lists(const BlockedSamples &samples, const TileTask &task);

} // namespace sparselens::gpu
