// What views show of a surface where parts of deep views tell of it (deep/view_samples.h).
//
// A part covers its own share of a pixel, not what the mean of a surface's pixels would say. Where a deep centre view sees the
// surface, its coverage, its depth and its ids stay, and views give the mean of its colours for what they cover; where it does not, coverage
// is the mean of the views that see it, by their vote (visibility_vote.h). Several parts of one pixel are composited first.
#pragma once

#include "base/matte.h"
#include "warp/surfaces.h"

#include <span>
#include <vector>

namespace sparselens {

class PartMeans {
public:
    // Refers to the views and to the mattes of their channels.
    PartMeans(const ReprojectedViews &views, double tolerance, std::span<const Matte> mattes);

    bool volumes() const { return volumes_; } // of any view
    bool tell_of(const Surface &surface) const;

    // Appends the samples of such a surface, one at most, to the last pixel of `out`.
    void append_mean(const Surface &surface, Ldi &out) const;
    // The same as the most central view shows it, or the centre view.
    void append_nearest(const Surface &surface, Ldi &out) const;
    // Appends those of the centre view that go on beyond its frame.
    void append_beyond(const Imath::V2i &pixel, Ldi &out) const;

private:
    struct Share {
        ViewSample sample;
        double weight, covers; // the weight of its values, and of its place
    };

    std::vector<Share> shares_of(std::span<const ViewSample> samples, double &pixels) const;
    MergedSample place_of(std::span<const Share> shares) const;
    void append_seen(std::span<const ViewSample> samples, Ldi &out) const;
    void append_hidden(std::span<const ViewSample> samples, Ldi &out) const;
    void append_as_it_is(const ViewSample &sample, Ldi &out) const;

    const ReprojectedViews &views_;
    double tolerance_;
    std::span<const Matte> mattes_;
    std::span<const Channel> channels_;
    std::size_t alpha_;
    std::vector<std::size_t> coverage_; // of each channel; npos: none
    bool volumes_ = false;
};

} // namespace sparselens
