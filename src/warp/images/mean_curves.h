// How well the views agree at steps of depth, pixel by pixel of a block.
#pragma once

#include "warp/images/matched_view.h"
#include "warp/images/robust_mean.h"

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace sparselens {

// Values for each step and each pixel of a block.
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
