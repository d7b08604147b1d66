// Compares the rows of a block of pixels with another view, four pixels at a time. This is most of the search's work.
#pragma once

#include "warp/images/matched_view.h"

namespace sparselens {

inline constexpr int patch_reach = 3, patch_side = 2 * patch_reach + 1; // pixels
inline constexpr int patch_row = 16;                                    // from one row of a block to the next

// A block and what lies around it, at most 14 pixels wide and high.
struct PatchBlock {
    const float *own[3]; // colours
    const float *counts; // 1: shows the surface; else 0
    float surface;
    int width, height;
};

// Writes the squared difference of each pixel from what the cutout shows there, R, G and B together, and 1 if the pixel
// can be compared: if it counts, and the view shows the surface, too. Else writes 0 to both. Returns whether all pixels
// that count can be compared.
bool compare_shifted(const PatchBlock &block, const MatchedView::Cutout &seen, float *squares,
                     float *compared);

// Sums a block of this width and height in place: a pixel then holds the sum over the patch whose upper left corner it
// is, if that lies in the block.
void sum_patches(float *values, int width, int height);

} // namespace sparselens
