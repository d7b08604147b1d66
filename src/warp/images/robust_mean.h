// The mean of how far views differ from the centre view, over the best three quarters of the views that can be
// compared, because one view may see something else there. NaN if fewer than half can be compared.
#pragma once

#include "warp/images/matched_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace sparselens {

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

} // namespace sparselens
