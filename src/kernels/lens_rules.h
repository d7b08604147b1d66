// The rules by which a lens point sees samples, and what it adds to a pixel (dof/lens/lens_gather.cpp, gpu/lens).
#pragma once

#include "kernels/surface.h"
#include "kernels/types.h"

#include <cstddef>

namespace sparselens::kernels {

// The order of samples in a cell. Samples store `upper`: background_upper, or the bits of their disparity, which is at
// least 0, plus 2.
inline constexpr uint background_upper = 1;
inline uint upper_of_depth(float depth) { return floatBitsToUint(depth) + 2; }
// 0 for a background, and for no sample.
inline float depth_of(uint upper) { return uintBitsToFloat(max(upper, 2u) - 2); }

// A tile counts what its lens points see in whole numbers, so all processors find the same.
struct TileUnits {
    float unit;        // units in a pixel; a power of two
    float lens_unit;   // CoCs are multiplied by it, and lens points divided; a power of two
    float farthest;    // pixels: no sample is moved farther
    float widest;      // pixels: no lens point brings a sample with a larger CoC into the tile
    float nearest;     // pixels: the greatest disparity
    float codes;       // depth codes in a pixel of disparity
    float image_codes; // codes of images in a pixel of CoC
};

// The code of a depth: greater if it is nearer. 0: no sample; 1: a background.
inline uint depth_code(uint upper, float nearest, float codes) {
    return upper <= background_upper ? upper : 2 + uint(int(min(depth_of(upper), nearest) * codes));
}
// The code of an image in a mirror or glass, greater if its CoC is smaller. `most`: the largest CoC.
inline uint image_code(float coc, float most, float image_codes) {
    return 1 + uint(int((most - (coc < -most ? -most : coc < most ? coc : most)) * image_codes));
}

// Rounds to a whole number of 16 bits, without a call.
inline int whole(float value, float most) {
    return int((value < -most ? -most : value < most ? value : most) + 32768.5f) - 32768;
}
// These round, along one axis, the place of a sample, in units from the middle of a tile, its CoC, and a lens point. Places
// have bounds: a sample on a bound is too far away for any lens point to bring it into the tile.
inline constexpr float around_tile_px = 37; // half a tile, the cells around it, and rounding
inline int whole_place(float at, float middle, float unit, float farthest) {
    return whole((at - middle) * unit, (farthest + around_tile_px) * unit);
}
inline float place_if_seen(float at, float coc, float widest) { return abs(coc) > widest ? -1e9f : at; }
inline int whole_coc(float coc, float coc_unit, float most) { return whole(coc * coc_unit, most); }
inline int whole_lens(float lens, float lens_unit) { return whole(lens / lens_unit * 32768, 32767); }
// Rounds downwards. A sum of whole numbers then lies in the cell of the exact sum on average, and in focus always.
inline int whole_shift(float shift, float unit, float farthest) {
    return whole(floor(shift * unit), farthest * unit);
}
inline int moved(int coc, int lens) { return ((coc * lens >> 14) + 1) >> 1; }

// Returns where a lens point sees a corner of a facet along one axis, in pixels from the corner of a tile's cells. The
// sample lies at `at`, and moves by `coc` times `lens`. `shift`: the point of the pixel that the lens point looks
// through, plus shift_of_facets, because facets are drawn where the middles of cells lie, and cells begin with one cell
// of border. The corner is subtracted first, so that far from the picture's corner nothing is rounded more than near it.
inline constexpr float shift_of_facets = 0.5f;
inline float seen_along(float at, float corner, float coc, float lens, float shift) {
    return (at - corner) + (coc * lens + shift);
}

// Pixels. A facet whose corners a lens point sees no farther apart than this, in x and in y, is not drawn, because the
// squares of its samples cover it.
inline constexpr float parted_px = 1 + 1.0f / 16;

// The cells, 1 to `last`, whose middle lies between the corners of a facet along an axis.
inline int first_between(float least, float last) {
    const float left = last - least;
    return int(last) - int(left > -1 ? (left < last - 1 ? left : last - 1) : -1);
}
inline int last_between(float most, float last) { return int(most > 0 ? (most < last ? most : last) : 0); }

// Twice the area of a triangle, positive if its corners are met clockwise as the picture shows them.
inline float twice_area(float x0, float y0, float x1, float y1, float x2, float y2) {
    return (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0);
}
// Returns the corner opposite the largest of three areas, which is the corner that weighs most.
inline uint nearest_corner(float a, float b, float c) { return max(a, b) >= c ? (a >= b ? 0u : 1u) : 2u; }

// Whether two samples on either side of an empty cell are one surface that parallax has torn. They must show one
// surface and be less than side_by_side_px apart in x and in y (pixels, before the lens point moves them): samples that
// are no farther apart have no other sample between them.
inline constexpr float side_by_side_px = 1.5f;
inline bool is_crack(float x, float y, float depth_a, float depth_b) {
    return abs(x) < side_by_side_px && abs(y) < side_by_side_px &&
           is_one_surface(depth_a, depth_b, one_surface_px);
}

// A crack lies between two samples, in front of something that is farther than both by more than this, in pixels of
// disparity. The unevenness of their surface never reaches that. `shown`: the depth code that a cell shows. A crack may
// lie in front of the cell if samples on two sides of it have greater codes than the result.
inline constexpr float behind_crack_px = 1;
inline uint behind_crack(uint shown, float codes) {
    return shown == 0 ? background_upper : shown + uint(int(behind_crack_px * codes));
}

// The code of a sample that hides a filler of this code is greater than the result.
inline uint behind_filler(uint code, float codes) { return code + uint(int(one_surface_px * codes)); }

// Whether an image in a mirror or glass is seen where their surface is.
inline bool is_in_mirror(float image_depth, float depth) {
    return is_one_surface(image_depth, depth, one_mirror_px);
}

// The share of light that is left behind a sample of partial coverage. It is less than 1, because a sample without
// coverage may still give light.
inline float left_behind(float transmittance, float left) {
    return min(transmittance * left, 1 - 1.0f / 16777216);
}

// Kinds of channels for a lens that treats colours differently; one bit each.
inline constexpr uint is_red = 1, is_green = 2, is_blue = 4, is_coverage = 8, is_data = 16;

// Picks the number that belongs to a channel; `others` belongs to coverage and data.
inline float of_colour(uint set, float red, float green, float blue, float others) {
    return set == is_red ? red : set == is_green ? green : set == is_blue ? blue : others;
}
// The weight of a lens point for a channel. `colour`: the factor of its colour, 1 for data. `side`: the factor on
// light from behind focus, or from in front of it, which data ignores.
inline float light_weight(uint set, float weight, float colour, float side) {
    return weight * colour * (set == is_data ? 1 : side);
}
// With a cat-eye that darkens, colours are averaged over lens points, not over their weights.
inline bool is_darkened(uint set, bool darkens) {
    return darkens && (set & (is_red | is_green | is_blue)) != 0;
}

// A weight that is only a rounding error counts as unknown.
inline float known_weight(float known, float total) { return known > 1e-6f * total ? known : 0; }

// How much of the light from depth z passes a sample of a holdout (deep/merge.h).

// Whether a sample that begins at `front` hides light from depth z. Depths that differ by rounding alone are equal, and
// do not hide each other.
template <typename Real>
inline bool is_held_out(Real front, Real z) {
    return front < z * (1 - 1 / Real(1000000));
}

// A volume hides by the share of it that lies in front of z. `clear`: the share of light that passes all of it.
template <typename Real>
inline Real passes_part(Real front, Real back, Real clear, Real z) {
    return back > z && clear > 0 ? pow(clear, (z - front) / (back - front)) : clear;
}

} // namespace sparselens::kernels

namespace sparselens::lens_kernel {

// The data that the CPU lays out for the lens gather on a device, and how the device divides it (gpu/lens).

using kernels::uint, kernels::TileUnits;

inline constexpr uint none = 0xffffffffu;
inline constexpr int tile_size = 64; // pixels a tile is wide and high
// Cells around a tile: one for the pixels next to it, and one for what falls outside of those.
inline constexpr int border = 2;
inline constexpr int tile_stride = tile_size + 2 * border;
inline constexpr int size = 32;                   // pixels a quarter of a tile is wide and high
inline constexpr uint quarters = 4;               // left and right above, left and right below
inline constexpr uint pixels = uint(size * size); // of a quarter
inline constexpr int side = size + 2;             // with the cells next to it, where cracks are looked for
inline constexpr uint cells = uint(side * side);
inline constexpr uint chunk = 256; // partial samples at once
inline constexpr uint team = 32;   // threads that share a block
inline constexpr uint wide = 4;    // columns of pixels in which a thread looks for cracks
// From one row of pixels to the next, owners (tile_data.glsl) are shifted by this many columns, so that several threads
// share the pixels of an upright object.
inline constexpr uint turn = 11;
// A bit of words and of the upper halves of samples: set for all samples but fillers.
inline constexpr uint hiding = 0x80000000u;
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
};
static_assert(sizeof(Lens) == 56 && offsetof(Lens, blue_in_front) == 52);

struct Tile {
    float x, y;                        // of its first pixel
    int size;                          // pixels across and down that are asked for
    float weight;                      // of all its lens points
    uint blocks, block_count;          // among the lists of blocks
    uint filler_count;                 // after them
    uint partial[4], partial_count[4]; // of each quarter, among the lists of partial samples
    uint lens, lens_count;             // among the lens points
    uint lens_in_pass;                 // the largest number of lens points in a pass
    uint facets, facet_count;          // blocks of them, among the lists of blocks
    uint solids, solid_count;          // among the lists of blocks
    // where the columns begin that say which pixels see through a lens point
    uint columns;
    uint holdout; // where the tile's parts of the holdout begin
    // where its runs of numbers begin among the lists of blocks, and how many there are: the first sample of each, and
    // its number; and where the sample of each number is
    uint runs, run_count, numbers;
    uint number_bits; // of a word
    TileUnits units;
};
static_assert(sizeof(Tile) == 140 && offsetof(Tile, lens) == 60 && offsetof(Tile, units) == 112);

// Lens points weigh differently for colours or for sides of the focus, or not all pixels see through them.
inline constexpr uint weighted = 1;
inline constexpr uint two_sided = 2; // lens points weigh differently for sides of the focus
inline constexpr uint images = 4;    // there are mirrors or glass
inline constexpr uint cat_eye = 8;   // not all pixels see through a lens point
inline constexpr uint darkens = 16;  // and this darkens the pixels
inline constexpr uint holdout = 32;  // a holdout stays sharp
inline constexpr uint with_partial = 64, with_facets = 128, with_solids = 256; // there are such samples

struct Push {
    uint tile_count, sample_count, pass;
    float depth_at_1; // disparity at z = 1
};
static_assert(sizeof(Push) == 16 && offsetof(Push, depth_at_1) == 12);

} // namespace sparselens::lens_kernel
