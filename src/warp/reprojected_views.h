// Views reprojected onto the centre view: every sample of every view in the pixel of the centre view into which it
// falls.
#pragma once

#include "deep/view_samples.h"
#include "view/view_mapping.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace sparselens {

// A pixel of a view at its position in the centre view.
struct ReprojectedSample {
    int x, y;             // the pixel of the centre view, EXR coordinates
    float dx, dy;         // offset from that pixel's centre, [-1/2, 1/2], y down
    float inverse_z;      // 1 / planar depth
    std::uint32_t source; // index of the view's sample
};

class Reprojection {
public:
    // The samples of the view lie at the pixel centres, at depths above 0. The view must outlive the reprojection.
    Reprojection(const ViewSamples &view, const ViewMapping &mapping);

    // A box that contains all pixels into which samples fall.
    Imath::Box2i reach() const;

    // Whether samples of a source row, counted from the top, may fall into those rows.
    bool may_reach(std::size_t row, int first_row, int last_row) const {
        return !(reach_[row].max.y < first_row || reach_[row].min.y >= last_row + 1);
    }

    // Appends every sample that falls into the rows [first_row, last_row], pixel by pixel of the view.
    void append_rows(int first_row, int last_row, std::vector<ReprojectedSample> &out) const;

    const ViewMapping &mapping() const { return mapping_; }

private:
    const ViewSamples &view_;
    ViewMapping mapping_;
    std::vector<Imath::Box2d> reach_; // of each source row: a box around the positions of its samples
};

// A sample of a view at its position in the centre view.
struct ViewSample : ReprojectedSample {
    std::uint32_t view;    // 0 is the centre
    std::uint32_t surface; // of the pixel, as find_surfaces() numbers them
    // The weight in the mean of its surface. Because a mean of pixels that lie apart is blurred, samples near the
    // middle of the pixel have more weight.
    double weight;
};

// Some rows of the centre view, pixel by pixel; within a pixel the views in order.
struct ReprojectedRows {
    int first_row = 0; // EXR coordinate
    std::vector<ViewSample> samples;
    std::vector<std::size_t> begin; // pixel i, counted along the rows, has samples [begin[i], begin[i + 1])
    std::vector<ReprojectedSample> by_view; // the same, view by view

    std::size_t pixels() const { return begin.size() - 1; }
    std::span<ViewSample> pixel(std::size_t i) {
        return std::span(samples).subspan(begin[i], begin[i + 1] - begin[i]);
    }
};

// Throws Error if display windows differ or a view lacks a channel of the centre, views[0].
void check_views(std::span<const PackedView> views);

class ReprojectedViews {
public:
    // views[0] is the centre, whose channels every view must have. The order of the others does not matter. `focal_px`
    // is F and `scale` is R F, see WarpOptions. Pixels on silhouettes of flat views become two samples where disparity
    // jumps by `jump` pixels (silhouettes.h); with a jump of 0 they stay whole. Throws like check_views().
    ReprojectedViews(std::vector<PackedView> views, double focal_px, double scale, double jump);
    // Refers to the views, which must outlive this.
    ReprojectedViews(std::span<const View> views, double focal_px, double scale, double jump)
        : ReprojectedViews(referring_to(views), focal_px, scale, jump) {}

    std::size_t size() const { return sources_.size(); }
    const ViewSamples &samples(std::size_t view) const { return sources_[view]->samples; }
    const Reprojection &reprojection(std::size_t view) const { return sources_[view]->reprojection; }

    float value(const ViewSample &s, std::size_t channel) const {
        return samples(s.view).value(channel, s.source);
    }

    bool some_are_deep() const { return some_are_deep_; }
    // Whether the sample, of a flat view among deep ones, shows no other surface.
    bool is_pure(const ViewSample &s) const {
        return s.source < mixed_[s.view].size() && !mixed_[s.view][s.source];
    }

    // Frees the samples of a view, which are not needed any more.
    void forget(std::size_t view) { sources_[view]->samples.forget(); }

    // The samples that fall into the rows [first_row, last_row] of the data window. Reuses the memory of rows that are
    // no longer needed.
    ReprojectedRows place(const Imath::Box2i &data, int first_row, int last_row,
                          ReprojectedRows no_longer_needed = {}) const;

private:
    struct Source {
        ViewSamples samples;
        Reprojection reprojection; // refers to the samples

        Source(ViewSamples of_view, const ViewMapping &mapping)
            : samples(std::move(of_view)), reprojection(samples, mapping) {}
    };
    bool some_are_deep_ = false;
    std::vector<std::vector<bool>> mixed_;         // if some views are deep
    std::vector<std::unique_ptr<Source>> sources_; // the centre, then the rim views in a canonical order
};

} // namespace sparselens
