// Compares a block of pixels of the centre view with other views, patch by patch, if what it shows lies at a given
// depth. Only pixels of one surface count, and only where the view shows that surface.
#pragma once

#include "warp/images/matched_view.h"

#include <array>
#include <span>

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

// Compares the rows of a block with another view, four pixels at a time. This is most of the search's work. Writes the
// squared difference of each pixel from what the cutout shows there, R, G and B together, and 1 if the pixel can be
// compared: if it counts, and the view shows the surface, too. Else writes 0 to both. Returns whether all pixels that
// count can be compared.
bool compare_shifted(const PatchBlock &block, const MatchedView::Cutout &seen, float *squares,
                     float *compared);

// Sums a block of this width and height in place: a pixel then holds the sum over the patch whose upper left corner it
// is, if that lies in the block.
void sum_patches(float *values, int width, int height);

class PatchComparison {
public:
    static constexpr int reach = patch_reach, patch = patch_side;
    static constexpr int most_side = 8 + 2 * reach; // a block of at most 8 x 8 and what lies around
    static constexpr int row = patch_row;           // pixels from one to the next
    // One value for each of these pixels, from the upper left corner.
    using Field = std::array<float, std::size_t(row) * most_side>;

    PatchComparison(const MatchedView &centre, const Imath::Box2i &block, float surface);

    Imath::V2i corner() const { return corner_; }
    int width() const { return width_; } // of the block and what lies around
    int height() const { return height_; }
    static std::size_t at(int x, int y) { return std::size_t(y * row + x); }

    // The perceptive depths of the surfaces; only those of pixels that count are known.
    const Field &own_depths() const { return depths_; }

    // Writes the difference at each pixel of the block, row by row, if what it and the pixels around show lies at one
    // perceptive depth: mean squares over the patch, of R, G and B together; NaN where too little can be compared.
    void at_depth(const MatchedView &view, double depth, std::span<float> out);
    // The same, if what they show lies at these depths plus `behind`; a pixel whose depth is NaN does not count.
    void at_depths(const MatchedView &view, const Field &depths, double behind, std::span<float> out);

private:
    // Writes squared differences, and which pixels can be compared.
    template <typename PlaceAt>
    void compare_each(const MatchedView &view, const PlaceAt &place_at);
    void take(std::span<float> out);

    float surface_;
    Imath::V2i corner_;
    int width_, height_;
    std::array<Field, 3> own_; // colours
    Field counts_;             // 1: shows the surface; else 0
    Field sums_of_counts_;     // over patches
    Field depths_;
    Field squares_, compared_;
    bool all_compared_ = false; // whether all pixels that count can be compared
};

} // namespace sparselens
