// Finds which samples of views in a pixel of the centre view show the same surface.
#pragma once

#include "base/matte.h"
#include "warp/reprojected_views.h"

#include <span>
#include <vector>

namespace sparselens {

struct Surface {
    std::span<const ViewSample> samples; // the centre's sample first, if it shows the surface; never empty
    double inverse_z;                    // weighted mean

    bool seen_by_centre() const { return samples[0].view == 0; }
};

// The surfaces of some rows of the centre view.
struct Surfaces {
    std::vector<Surface> list;      // front to back within a pixel; refer to the rows' samples
    std::vector<std::size_t> begin; // pixel i, as in ReprojectedRows, has surfaces [begin[i], begin[i + 1])

    std::size_t pixels() const { return begin.size() - 1; }
    std::span<const Surface> pixel(std::size_t i) const {
        return std::span(list).subspan(begin[i], begin[i + 1] - begin[i]);
    }
};

// The parts that the nearest pixel of the frame of a deep centre view holds, for a pixel beyond the frame; else empty.
// If there are any, pixels of flat views count as mixed there and are left out, and the parts continue.
SampleRange parts_leave_frame(const ViewSamples &centre, Imath::V2i pixel);

// Two samples show the same surface if their 1 / z differ by less than `tolerance` (inf: always). Samples in front of
// what the centre view shows, or where it shows empty space, do not belong to the pixel: only the rounding of their
// positions brought them there. Reorders the samples of each pixel.
//
// A deep centre view shows everything in its pixel, down to the depth where nothing shows through. Each of its samples
// is a surface, which has the samples of rim views that are nearest to it in depth; other surfaces lie behind all of
// them. A part of a deep view's pixel (view_samples.h) belongs to one surface. If the centre view sees that surface,
// pixels of flat views that mix several surfaces (reprojected_views.h) are not averaged with it.
Surfaces find_surfaces(const ReprojectedViews &views, double tolerance, ReprojectedRows &rows);

// Averages what views show of a surface.
//
// The mean of pixels has the colours that the views show by their weights, and covers by their votes (coverage.h).
//
// A part of a deep view (deep/view_samples.h) covers its own share of a pixel, not the share that the mean of a surface's
// pixels would give. If a deep centre view sees the surface, its coverage, depth and ids stay, and its colours become
// the mean over the views, relative to what they cover. If it does not, the coverage is the mean over the views that see
// the surface, by their vote. Several parts of one pixel are composited first.
class SurfaceMeans {
public:
    // Refers to the views and to the mattes of their channels.
    SurfaceMeans(const ReprojectedViews &views, double tolerance, std::span<const Matte> mattes);

    bool volumes() const { return volumes_; }       // whether any view has volumes
    bool is_of_parts(const Surface &surface) const; // whether any sample is a part

    // Each appends the surface, as one sample at most, to the last pixel of `out`.
    void append_of_parts(const Surface &surface, Ldi &out) const;
    void append_of_pixels(std::span<const ViewSample> samples, Ldi &out) const;
    // As the centre view shows the surface; else as the most central view shows it.
    void append_nearest(const Surface &surface, Ldi &out) const;
    // Appends the parts of the centre view that continue beyond its frame.
    void append_beyond(const Imath::V2i &pixel, Ldi &out) const;

private:
    struct Share : ViewSample { // with the weight of its values
        double covers;          // the weight of its position
    };

    std::vector<Share> shares_of(std::span<const ViewSample> samples, double &pixels) const;
    MergedSample place_of(std::span<const Share> shares) const;
    void append_seen(std::span<const ViewSample> samples, Ldi &out) const;
    void append_hidden(std::span<const ViewSample> samples, Ldi &out) const;
    void append_as_it_is(const ViewSample &sample, Ldi &out) const;
    template <typename Samples>
    void append_values(const Samples &samples, double weights, double coverage, Ldi &out) const;

    const ReprojectedViews &views_;
    double tolerance_;
    std::span<const Matte> mattes_;
    std::span<const Channel> channels_;
    std::size_t alpha_;
    std::vector<std::size_t> coverage_; // of each channel; npos: none
    std::vector<bool> ids_;             // whether a channel holds_ids()
    bool volumes_ = false;
};

} // namespace sparselens
