// The coverage of a surface that the centre view does not see, by a vote of the rim views.
//
// A pixel of one view on an edge claims the whole pixel for the surface. Of the other views of the same position, some
// see the surface and some see past it. If every claim counted, the surface would grow with every view; by majority it
// keeps its size, and its edge becomes softer with more views. The mean of what the views show is right on average, but
// also keeps what a few views misplaced. Both together are better than either.
//
// A veil, or an edge in front of nothing, covers a part of the pixels that see it. Its samples already have that
// coverage, so the vote must not reduce it again: what a pixel leaves open is not a vote against what it sees there.
#pragma once

#include "warp/reprojected_views.h"

#include <functional>

namespace sparselens {

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

} // namespace sparselens
