// The coverage of a surface that the centre view does not see, by a vote of the rim views.
//
// A pixel of one view on an edge claims the whole pixel for the surface. Of the other views of the same position, some
// see the surface and some see past it. If every claim counted, the surface would grow with every view; by majority it
// keeps its size, and its edge becomes softer with more views.
#pragma once

#include "warp/reprojected_views.h"

namespace sparselens {

// The coverage, 0..1, of a surface at (x, y) of the centre view (pixels) and depth 1 / inverse_z. It is 1 where three
// quarters of the rim views that can tell see the surface, 0 where a quarter or fewer do, and in proportion between; 1
// where no view can tell. A view can tell unless something nearer hides the position or it lies outside the view.
// Depths whose inverses differ by less than `tolerance` are the same.
double visibility_vote(const ReprojectedViews &views, const Imath::V2d &place, double inverse_z,
                       double tolerance);

} // namespace sparselens
