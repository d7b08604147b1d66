// Averages what views show of a surface if parts of deep views (deep/view_samples.h) show it.
//
// A part covers its own share of a pixel, not the share that the mean of a surface's pixels would give. If a deep
// centre view sees the surface, its coverage, depth and ids stay, and its colours become the mean over the views,
// relative to what they cover. If it does not, the coverage is the mean over the views that see the surface, by their
// vote (visibility_vote.h). Several parts of one pixel are composited first.
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

    bool volumes() const { return volumes_; } // whether any view has volumes
    bool tell_of(const Surface &surface) const;

    // Appends such a surface, as one sample at most, to the last pixel of `out`.
    void append_mean(const Surface &surface, Ldi &out) const;
    // The same, as the centre view shows the surface; else as the most central view shows it.
    void append_nearest(const Surface &surface, Ldi &out) const;
    // Appends the parts of the centre view that continue beyond its frame.
    void append_beyond(const Imath::V2i &pixel, Ldi &out) const;

private:
    struct Share {
        ViewSample sample;
        double weight, covers; // the weight of its values, and of its position
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
