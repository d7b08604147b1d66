// Whether views of a block of pixels agree (warp/photo_consistency.h).
#pragma once

#include "kernels/types.h"

namespace sparselens::kernels {

inline constexpr int photo_block = 8; // pixels wide and high

// Bounds a value, so that one bright pixel does not decide for its block.
template <typename Real>
inline Real bounded(Real v) {
    return v / (1 + abs(v));
}

// The sums over the pixels of a block so far.
struct PhotoBlock {
    double difference, variation; // sums of squares over channels
    double coc;                   // sum of |CoC|
    double pixels;
    // Sums over each sample of a rim view and each channel: of the difference, and of how the difference changes with
    // the depth of the picture, which is the gradient along the direction in which the picture moves.
    double change2, change_difference, difference2, values;
};

inline void add_motion(PhotoBlock &block, double difference, double change) {
    block.change2 += change * change;
    block.change_difference += change * difference;
    block.difference2 += difference * difference;
    block.values += 1;
}
inline void add_channel(PhotoBlock &block, double difference, double variation) {
    block.difference += difference * difference;
    block.variation += variation * variation;
}
inline void add_pixel(PhotoBlock &block, double coc) {
    block.coc += coc;
    block.pixels += 1;
}

inline constexpr double focus_px = 2; // CoC up to which a surface counts as in focus

// Whether views differ by more than noise.
inline bool views_differ(PhotoBlock block) {
    const double least_ratio = 3;         // noise alone gives up to 1.6, edges of texture up to 2
    const double least_difference = 1e-5; // mean square, tone-mapped: less is not seen
    return block.difference > least_ratio * block.variation + least_difference * block.pixels;
}

// Returns by how much another depth than the surface's would explain much of the difference, by linear regression, in
// pixels of perceptive depth; 0 if it would not.
inline double explaining_motion(PhotoBlock block) {
    const double least_explained = 0.5; // share of the squared differences; noise alone gives a hundredth
    const double least_change = 1e-5;   // mean square for each pixel of depth: nothing else tells
    if (!(block.change2 > least_change * block.values)) return 0;
    const double moved = block.change_difference / block.change2, explained = moved * block.change_difference;
    return explained >= least_explained * block.difference2 ? abs(moved) : 0.0;
}

// The unit of the motions of images, in pixels of perceptive depth, if `across` pixels, across and down, become one
// pixel of the picture. An image is worth finding if it moves by at least a quarter of the unit: between opposite
// views, by a quarter of a pixel of the picture.
inline double motion_unit(int across) { return across > 2 ? 0.5 * double(across) : 1.0; }

// A verdict is a set of these.
inline constexpr uint may_average = 1, differs_slightly = 2, differs_clearly = 4;
inline uint photo_verdict(PhotoBlock block, double unit) { // motion_unit()
    const double least_motion = 0.3 * unit;                // pixels of perceptive depth
    const double clear_motion = 0.5 * unit;                // the same; sharp edges seem to move by less
    const bool differ = views_differ(block), in_focus = block.coc <= focus_px * block.pixels;
    const double moved = explaining_motion(block);
    const uint averages = !differ || in_focus ? may_average : 0u;
    return averages | (differ || moved >= clear_motion ? differs_clearly
                       : moved >= least_motion         ? differs_slightly
                                                       : 0u);
}

} // namespace sparselens::kernels
