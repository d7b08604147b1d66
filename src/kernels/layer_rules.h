// How the splats over a pixel become its colour: depth bins become layers, and layers become the picture
// (dof/selective/splats.h).
#pragma once

#include "kernels/psf_rules.h"
#include "kernels/types.h"

#include <cstddef>

namespace sparselens::kernels {

// A bin with a smaller known sum holds only what rounding left at a disc's edge.
inline constexpr double least_known = 1e-12;

// Bins that follow each other without a gap are one layer.
inline bool joins_layer(int bin, int last_bin) { return bin <= last_bin + 1; }

// The part of a disc around the middle of a pixel that lies in the data window.
inline double window_share(int x_min, int y_min, int x_max, int y_max, double pixel_aspect, int x, int y,
                           double radius) {
    const double left = x + 0.5 - x_min, right = x_max + 0.5 - x, above = y + 0.5 - y_min,
                 below = y_max + 0.5 - y, high = radius * pixel_aspect;
    if (left >= radius && right >= radius && above >= high && below >= high) return 1;
    const double area = area_between(radius, x_min - (x + 0.5), (y_min - (y + 0.5)) / pixel_aspect,
                                     x_max + 1 - (x + 0.5), (y_max + 1 - (y + 0.5)) / pixel_aspect);
    return area / (pi * radius * radius);
}

// The share of light that a layer takes, going from back to front. `known`: what is known of the layer and of what lies
// behind it.
inline double layer_share(double coverage, double known) { return min(1.0, coverage / min(1.0, known)); }
// Composites the light, or the coverage, of a layer over what lies behind it.
inline double over(double share, double light, double behind) { return share * light + (1 - share) * behind; }

} // namespace sparselens::kernels

namespace sparselens::splat_kernel {

// The data that the CPU lays out for the selective gather on a device, and how the device divides it (gpu/selective).

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
    uint tile_count, pass, passes, splat_count, limit, unused;
};
static_assert(sizeof(Push) == 48 && offsetof(Push, limit) == 40);

} // namespace sparselens::splat_kernel
