// By which rules a tile is gathered on a device, and what these rules look up for each of its pixels: which lens points it sees
// through past a cat-eye, and what a holdout lets through there.
#pragma once

#include "dof/device/tile_device.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace sparselens::gpu {

inline constexpr int tile_size = 64; // LensTile::size
inline constexpr std::size_t tile_pixels = tile_size * tile_size;

// As in the shader; one bit each.
enum Rules : std::uint32_t {
    weighted = 1,
    two_sided = 2,
    images = 4,
    cat_eye = 8,
    darkens = 16,
    holdout = 32
};

// All but `images`.
std::uint32_t rules_of(const TileScene &scene, std::span<const LensSample> lens);

// [lens point][two rows]: where the pixels of a row begin that see through it, and where they end, 8 bits each. None without
// a cat-eye.
std::size_t column_words(const TileScene &scene, const TileTask &task);
void place_columns(std::span<std::uint32_t> to, const TileScene &scene, const TileTask &task);

// Of each pixel, which of the tile's parts of the holdout is its first, then how many these all are; then of each part front,
// back and the share that it lets through (bits of float). None without a holdout.
std::size_t holdout_words(const TileScene &scene, const TileTask &task);
void place_holdout(std::span<std::uint32_t> to, const TileScene &scene, const TileTask &task);

} // namespace sparselens::gpu
