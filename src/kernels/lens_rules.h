// By which rules a lens point sees samples, and what it adds to a pixel (dof/lens/gather_tile.h, gpu/lens).
#pragma once

#include "kernels/surface.h"
#include "kernels/types.h"

namespace sparselens::kernels {

// Keys: nearer is greater. The upper half is that of a background, or says the perceptive depth, which is at least 0; the lower
// half is the sample's index. 0 is none.
inline constexpr uint background_upper = 1;
inline uint upper_of_depth(float depth) { return floatBitsToUint(depth) + 2; }
inline float depth_of(uint upper) {
    return uintBitsToFloat(max(upper, 2u) - 2);
} // 0 of a background, and of none
inline uint64_t key_of(uint upper, uint index) { return (uint64_t(upper) << 32) | uint64_t(index); }
inline uint upper_of(uint64_t key) { return uint(key >> 32); }
inline uint sample_of(uint64_t key) { return uint(key & 0xffffffffUL); }

// Along one axis, pixels from the corner of a tile's cells: where a lens point sees what lies at `at` and moves by `coc` for
// each `lens`. The corner is taken off first, so that far from the picture's corner nothing is rounded more than near it.
inline float seen_along(float at, float corner, float coc, float lens, float shift) {
    return (at - corner) + (coc * lens + shift);
}
// `shift`, besides where in the pixel the lens point looks: cells begin with one of border; a sample is a square of one
// pixel, while facets are drawn where the middles of cells lie.
inline constexpr float shift_of_samples = 1;
inline constexpr float shift_of_facets = 0.5f;

// The cell of a sample, not rounded; outside: the first or the last. One bound after the other, so that each is one
// instruction.
inline float cell_along(float seen, float last) {
    const float from_first = seen > 0 ? seen : 0;
    return from_first < last ? from_first : last;
}

// A facet whose corners a lens point sees no farther apart than that, in x and in y, in pixels, is not drawn: the squares of
// its samples cover it.
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
// The corner over against the largest of three areas: that which weighs most.
inline uint nearest_corner(float a, float b, float c) { return max(a, b) >= c ? (a >= b ? 0u : 1u) : 2u; }

// Two samples on either side of an empty cell, so far apart in x and y (pixels, not moved by the lens point): a surface torn
// by parallax, if they show one. Samples that are no farther apart have none between them.
inline constexpr float side_by_side_px = 1.5f;
inline bool is_crack(float x, float y, float depth_a, float depth_b) {
    return abs(x) < side_by_side_px && abs(y) < side_by_side_px &&
           is_one_surface(depth_a, depth_b, one_surface_px);
}

// A crack lies between two samples, in front of what is farther than both by more than this, in pixels of perceptive depth: as
// much as what their own unevenness never reaches. What a cell shows has a key; samples that may have a crack in front of it
// between them have greater ones.
inline constexpr float behind_crack_px = 1;
inline uint64_t behind_crack(uint64_t shown) {
    const float depth = depth_of(upper_of(shown)) + behind_crack_px;
    return key_of(shown == 0 ? background_upper : upper_of_depth(depth), 0xffffffffu);
}

// A sample that hides a filler of that depth has a greater key.
inline uint64_t hiding_key(float depth) {
    return key_of(upper_of_depth(depth + one_surface_px), 0xffffffffu);
}

// Whether an image in a mirror or glass is seen where their surface is.
inline bool is_in_mirror(float image_depth, float depth) {
    return is_one_surface(image_depth, depth, one_mirror_px);
}

// What a sample of partial coverage leaves of the light behind it: less than all, as a sample without coverage may still
// give light.
inline float left_behind(float transmittance, float left) {
    return min(transmittance * left, 1 - 1.0f / 16777216);
}

// Kinds of channels for a lens that treats colours differently; one bit each.
inline constexpr uint is_red = 1, is_green = 2, is_blue = 4, is_coverage = 8, is_data = 16;

// Factor of a lens point on a channel; `side`: for light from behind focus, or from in front. Data has no colour and is the same for
// all light.
inline float light_weight(uint set, float weight, float red, float green, float blue, float side) {
    const float colour = set == is_red ? red : set == is_green ? green : set == is_blue ? blue : 1;
    return weight * colour * (set == is_data ? 1 : side);
}
// Past a cat's eye that darkens, the mean of colours is that over lens points, not over weights.
inline bool is_darkened(uint set, bool darkens) {
    return darkens && (set & (is_red | is_green | is_blue)) != 0;
}

// A weight that is only a rounding error counts as unknown.
inline float known_weight(float known, float total) { return known > 1e-6f * total ? known : 0; }

} // namespace sparselens::kernels
