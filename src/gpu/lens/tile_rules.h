// The rules by which a tile is gathered on a device, and what these rules look up for each of its pixels: which lens
// points it sees through past a cat-eye, and what a holdout lets through there.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "kernels/lens_layout.h"

#include <cstddef>
#include <cstdint>
#include <span>

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

} // namespace sparselens::gpu
