// The data that the CPU lays out for the lens gather on a device, and how the device divides it (gpu/lens).
#pragma once

#include "kernels/types.h"

#include <cstddef>

namespace sparselens::lens_kernel {

using kernels::uint;

inline constexpr uint none = 0xffffffffu;
inline constexpr int tile_size = 64; // pixels a tile is wide and high
// Cells around a tile: one for the pixels next to it, and one for what falls outside of those.
inline constexpr int border = 2;
inline constexpr int tile_stride = tile_size + 2 * border;
inline constexpr uint threads = 256;              // of a work group, which gathers
inline constexpr int size = 32;                   // pixels a quarter of a tile is wide and high
inline constexpr uint quarters = 4;               // left and right above, left and right below
inline constexpr uint pixels = uint(size * size); // of a quarter
inline constexpr uint own = pixels / threads;     // pixels of a thread
inline constexpr int side = size + 2;             // with the cells next to it, where cracks are looked for
inline constexpr uint cells = uint(side * side);
inline constexpr uint chunk = 512; // partial samples at once
static_assert(tile_size == 2 * size);

// A block of samples or facets; lengths in pixels.
struct Block {
    uint begin, opaque_end;
    float x_min, x_max, y_min, y_max, coc_min, coc_max;
};
static_assert(sizeof(Block) == 32 && offsetof(Block, coc_max) == 28);

struct Lens {
    float x, y, pixel_x, pixel_y, weight;
    // Factors on the weight, for R, G and B: of the lens point, and for light from behind focus and in front.
    float red, green, blue;
    float red_behind, green_behind, blue_behind, red_in_front, green_in_front, blue_in_front;
    float weight_before; // sum of the weights of the tile's lens points before it
};
static_assert(sizeof(Lens) == 60 && offsetof(Lens, weight_before) == 56);

struct Tile {
    float x, y;                        // of its first pixel
    uint blocks, block_count;          // among the lists of blocks
    uint fillers, filler_count;        // among the lists of blocks
    uint partial[4], partial_count[4]; // of each quarter, among the lists of partial samples
    uint lens, lens_count;             // among the lens points
    uint lens_in_pass;                 // the largest number of lens points in a pass
    uint facets, facet_count;          // blocks of them, among the lists of blocks
    uint rules;                        // a set of the following
    // where the columns begin that say which pixels see through a lens point
    uint columns;
    uint holdout;             // where the tile's parts of the holdout begin
    uint solids, solid_count; // among the lists of blocks
};
static_assert(sizeof(Tile) == 96 && offsetof(Tile, lens) == 56 && offsetof(Tile, solid_count) == 92);

// Lens points weigh differently for colours or for sides of the focus, or not all pixels see through them.
inline constexpr uint weighted = 1;
inline constexpr uint two_sided = 2; // lens points weigh differently for sides of the focus
inline constexpr uint images = 4;    // mirrors or glass reach the tile
inline constexpr uint cat_eye = 8;   // not all pixels see through a lens point
inline constexpr uint darkens = 16;  // and this darkens the pixels
inline constexpr uint holdout = 32;  // a holdout stays sharp

struct Push {
    uint first_tile, tile_count, sample_count, first_filler, pass;
    float depth_at_1; // perceptive depth at z = 1
};
static_assert(sizeof(Push) == 24 && offsetof(Push, depth_at_1) == 20);

} // namespace sparselens::lens_kernel
