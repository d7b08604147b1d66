// The data that the CPU lays out for the selective gather on a device, and how the device divides it (gpu/selective).
#pragma once

#include "kernels/types.h"

#include <cstddef>

namespace sparselens::splat_kernel {

using kernels::uint;

inline constexpr int size = 32;      // pixels a tile is wide and high, at most
inline constexpr uint threads = 256; // of a work group, which gathers a tile
inline constexpr uint pixels = uint(size * size);
inline constexpr uint own = pixels / threads; // pixels of a thread
inline constexpr uint chunk = 32;             // splats at once, as many as a number has bits
inline constexpr int strip_size = 8;          // pixels of a row of the tile
inline constexpr uint strips = 4;             // a row
inline constexpr uint edges = uint(size + 1); // of columns, or of rows
inline constexpr uint bin_sums = 7;           // coverage, known, four colours, known times radius
inline constexpr uint layer_sums = 6;         // the same without the last one
static_assert(strips * strip_size == size && strips * size * 2 == threads);

struct Tile {
    int x_min, y_min, x_max, y_max; // its pixels, the last ones included
};
static_assert(sizeof(Tile) == 16 && offsetof(Tile, y_max) == 12);

// Up to 1024 splats of a block, which lie in one bin.
struct Piece {
    uint begin, end; // splats
    int bin;
    uint block;
};
static_assert(sizeof(Piece) == 16 && offsetof(Piece, block) == 12);

// Bits of an entry in a tile's list; the rest of the entry is 4 times the number of the piece.
inline constexpr uint ends_bin = 1, covers = 2;

struct Push {
    double pixel_aspect;
    int data_x_min, data_y_min, data_x_max, data_y_max; // window: the first pixel and the last
    uint first_tile, tile_count, pass, passes, splat_count, limit;
};
static_assert(sizeof(Push) == 48 && offsetof(Push, limit) == 44);

} // namespace sparselens::splat_kernel
