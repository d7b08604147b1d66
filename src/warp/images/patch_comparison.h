// Compares a block of pixels of the centre view with other views, patch by patch, if what it shows lies at a given
// depth. Only pixels of one surface count, and only where the view shows that surface.
#pragma once

#include "warp/images/matched_view.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

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

    // The disparities of the surfaces; only those of pixels that count are known.
    const Field &own_depths() const { return depths_; }

    // Writes the difference at each pixel of the block, row by row, if what it and the pixels around show lies at one
    // disparity: mean squares over the patch, of R, G and B together; NaN where too little can be compared.
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

// The mean of how far views differ from the centre view, over the best three quarters of the views that can be
// compared, because one view may see something else there. NaN if fewer than half can be compared.

// Robust means of several pixels at once. The differences are kept sorted, so that the order of the views does not
// matter.
class RobustMeans {
public:
    RobustMeans(std::size_t views, std::size_t pixels)
        : views_(views), pixels_(pixels), ranks_(views * pixels), known_(pixels), worse_(pixels) {}

    // Adds the differences of the next view, by pixel; NaN where it cannot be compared. take() must be called after the
    // last view; then the first view may be added again.
    void add(std::span<const float> differences) {
        constexpr float last = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < pixels_; ++i) {
            const bool is_known = differences[i] == differences[i];
            worse_[i] = is_known ? differences[i] : last;
            known_[i] += is_known ? 1 : 0;
        }
        for (std::size_t r = 0; r < added_; ++r) {
            float *rank = &ranks_[r * pixels_];
            for (std::size_t i = 0; i < pixels_; ++i) {
                const float better = std::min(rank[i], worse_[i]);
                worse_[i] = std::max(rank[i], worse_[i]);
                rank[i] = better;
            }
        }
        std::copy(worse_.begin(), worse_.end(), ranks_.begin() + std::ptrdiff_t(added_ * pixels_));
        ++added_;
    }

    void take(std::span<float> means) {
        std::fill_n(means.begin(), pixels_, 0.0f);
        for (std::size_t r = 0; r < views_; ++r) {
            const float *rank = &ranks_[r * pixels_];
            for (std::size_t i = 0; i < pixels_; ++i) means[i] += int(r) < best(known_[i]) ? rank[i] : 0;
        }
        for (std::size_t i = 0; i < pixels_; ++i) {
            const bool enough = known_[i] > 0 && 2 * known_[i] >= int(views_);
            means[i] = enough ? means[i] / float(best(known_[i])) : std::numeric_limits<float>::quiet_NaN();
            known_[i] = 0;
        }
        added_ = 0;
    }

private:
    static int best(int known) { return (3 * known + 3) / 4; }

    std::size_t views_, pixels_, added_ = 0;
    std::vector<float> ranks_; // by rank, then pixel
    std::vector<int> known_;   // views
    std::vector<float> worse_;
};

// The robust means of `pixels` pixels; the differences come view by view.
inline std::vector<float> robust_means(std::span<const float> differences, std::size_t pixels) {
    RobustMeans robust(differences.size() / pixels, pixels);
    for (; !differences.empty(); differences = differences.subspan(pixels))
        robust.add(differences.first(pixels));
    std::vector<float> means(pixels);
    robust.take(means);
    return means;
}

// How well the views agree at steps of depth: values for each step and each pixel of a block.
class Curves {
public:
    Curves(std::size_t steps, std::size_t pixels)
        : pixels_(pixels), values_(steps * pixels, std::numeric_limits<float>::quiet_NaN()) {}
    float &at(std::size_t k, std::size_t pixel) { return values_[k * pixels_ + pixel]; }
    float at(std::size_t k, std::size_t pixel) const { return values_[k * pixels_ + pixel]; }
    std::span<float> step_of(std::size_t k) { return std::span(values_).subspan(k * pixels_, pixels_); }

private:
    std::size_t pixels_;
    std::vector<float> values_;
};

// The difference of each pixel of a block at steps of depth, the robust mean over the rim views; unknown at first.
class MeanCurves : public Curves {
public:
    MeanCurves(std::span<const MatchedView> views, std::size_t steps, std::size_t pixels)
        : Curves(steps, pixels), rims_(views.subspan(1)), means_(rims_.size(), pixels), differences_(pixels) {
    }

    // compare(view, out) compares the block with one view at step k.
    template <class Compare>
    void find(std::size_t k, const Compare &compare) {
        for (const MatchedView &view : rims_) {
            compare(view, std::span(differences_));
            means_.add(differences_);
        }
        means_.take(step_of(k));
    }

private:
    std::span<const MatchedView> rims_;
    RobustMeans means_;
    std::vector<float> differences_;
};

enum class Disagreement : std::uint8_t {
    none,   // no more than noise
    slight, // like an image that moves a little against its surface, or a sharp edge of texture
    clear   // more than that
};

} // namespace sparselens
