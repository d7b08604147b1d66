// The rules by which a tile is gathered on a device, and what these rules look up for each of its pixels: which lens
// points it sees through past a cat-eye, and what a holdout lets through there; and for its quarters, their samples of
// partial coverage.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/sample_blocks.h"
#include "kernels/lens_layout.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::gpu {

inline constexpr std::size_t tile_pixels = lens_kernel::tile_size * lens_kernel::tile_size;

// Returns the rules of lens_layout.h, except `images`.
std::uint32_t rules_of(const GatherScene &scene, std::span<const LensSample> lens);

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
