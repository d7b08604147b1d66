// The weights and the coverage of surfaces in the LDI, where some views miss them or disagree.
#pragma once

#include "deep/ldi.h"
#include "kernels/warp_rules.h"
#include "warp/reprojected_views.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

namespace sparselens {

// The weights of the samples of a surface if views of it are missing.
//
// Views from opposite sides of the lens see a surface at opposite offsets from the middle of a pixel, so the mean of
// all of them lies near the middle. Where some views were not rendered (plan/plan.h), the mean of the others does not:
// adjacent pixels, with a view and without it, are shifted against each other, which blurs what is in focus. There the
// samples get the weights of the best linear unbiased estimate of the colour in the middle: a sample of weight w has
// noise of variance 1 / w, and the colour's gradient is unknown, `gradient_to_noise` per pixel along each axis.

// Whether the view was not rendered where it would see that position.
inline bool is_missing(const ReprojectedViews &views, std::size_t view, const Imath::V2d &place,
                       double inverse_z) {
    const Windows &windows = views.samples(view).windows;
    const ViewMapping &mapping = views.reprojection(view).mapping();
    const Imath::V2d seen = mapping.in_view(place, inverse_z);
    // Pixels beyond the centre view's frame in that direction are not missing, however the view is framed.
    const Imath::V2d towards = mapping.at_infinity(seen);
    const Imath::Box2i &frame = views.samples(0).windows.data;
    if (!kernels::lies_in(towards.x, frame.min.x, frame.max.x)) return false;
    if (!kernels::lies_in(towards.y, frame.min.y, frame.max.y)) return false;
    const Imath::V2i pixel(int(std::floor(seen.x)), int(std::floor(seen.y)));
    return !windows.data.intersects(pixel) || views.samples(view).pixel(windows.index(pixel)).empty();
}

// Whether some view has no pixel where it would see the surface of these samples, because it was not rendered there.
inline bool some_view_is_missing(const ReprojectedViews &views, std::span<const ViewSample> samples) {
    const ViewSample &first = samples[0];
    const Imath::V2d place(first.x + 0.5 + double(first.dx), first.y + 0.5 + double(first.dy));
    for (std::size_t view = 1; view < views.size(); ++view) {
        const bool is_there = std::ranges::find(samples, view, &ViewSample::view) != samples.end();
        if (!is_there && is_missing(views, view, place, double(first.inverse_z))) return true;
    }
    return false;
}

// Returns the samples with these weights, up to a common factor. There must be at least one.
inline std::vector<ViewSample> balanced(std::span<const ViewSample> samples) {
    kernels::Offsets offsets = kernels::no_offsets();
    for (const ViewSample &s : samples) kernels::add_offset(offsets, s.weight, double(s.dx), double(s.dy));
    const double by_x = kernels::balance_x(offsets), by_y = kernels::balance_y(offsets);
    std::vector<ViewSample> result(samples.begin(), samples.end());
    for (ViewSample &s : result) s.weight *= kernels::balanced_share(double(s.dx), double(s.dy), by_x, by_y);
    return result;
}

// The coverage of a surface that the centre view does not see, by a vote of the rim views.
//
// On an edge, a sample of one view covers its whole pixel, but the surface covers only a part of it. Other views of the
// same position see the surface or see past it. If every sample counted, the surface would grow with every view. By the
// majority of the views it keeps its size, and its edge becomes softer with more views. The mean of what the views show
// is right on average, but also keeps what a few views misplaced. Both together are better than either.
//
// A veil, or an edge in front of nothing, covers a part of the pixels that see it. Its samples already have that
// coverage, so the vote must not reduce it again: what a pixel leaves open is not a vote against what it sees there.

// The votes of rim views on a position. Each view has up to 1.
struct Votes {
    double there = 0;   // they see the surface
    double past = 0;    // they see past it,
    double open = 0;    // of that, past everything
    double through = 0; // of that (deep views: of `past`), in pixels that also see the surface
    double all() const { return there + past; }
};

// A sample that a view sees past the surface, and how much of the view's pixel it covers, above 0.
using SeePast = std::function<void(const ViewSamples &view, std::uint64_t sample, double covers)>;

// Votes on a surface at (x, y) of the centre view (pixels) and depth 1 / inverse_z. A view says nothing where something
// nearer hides the position or where it lies outside the view. Depths whose inverses differ by less than `tolerance`
// are the same.
Votes votes_on(const ReprojectedViews &views, const Imath::V2d &place, double inverse_z, double tolerance,
               const SeePast &past = {});

// The coverage, 0..1, of such a surface by majority: 1 where three quarters of the votes are for it, 0 where a quarter or
// fewer are, and in proportion between; 1 where no view can tell.
double coverage_by_majority(const Votes &votes);

// The coverage, 0..1, by which the samples of such a surface are multiplied, which cover `shown` of their own pixels on
// average: half by majority, half by the mean of what the votes say is there.
double coverage_by_votes(const Votes &votes, double shown);

// Keeps pixels opaque that are opaque in the views: the samples of such a pixel let no light through.
//
// The mean of a surface has the mean of its samples' coverage, and the vote of the views reduces surfaces that the
// centre view does not see. Their background lies elsewhere in another view, so that the samples which fall into one
// pixel need not add up to a whole one. The light that rim views see past the last sample fills the rest, at the depth
// of that sample, so that the sample does not grow. If no view sees past it, its own colour fills the rest. If views
// see past everything, that share of them leaves the rest open: elements over nothing keep edges that let light
// through.

// `ldi` is warped from the views; `tolerance`: of 1 / z, within one surface. Pixels that let light through in the
// centre view stay as they are; beyond its frame, pixels about which no rim view can tell.
void keep_opaque(const ReprojectedViews &views, double tolerance, Ldi &ldi);

} // namespace sparselens
