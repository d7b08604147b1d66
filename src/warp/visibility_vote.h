// How much of a surface that the centre view does not see is really there.
//
// One view's pixel on an edge claims the whole pixel for the surface. Other views see the same place: some see the
// surface there, some see past it. Taken by themselves the claims add up, and the surface grows with every view; by
// majority it keeps its size, and its edge is the softer the more views there are.
#pragma once

#include "warp/reprojected_views.h"

namespace sparselens {

// Coverage, 0..1, of a surface at (x, y) of the centre view (pixels) and depth 1 / inverse_z: 1 where three quarters
// of the rim views that can tell see it there, 0 where a quarter or less do, between them in proportion; 1 where no
// view can tell. A view can tell unless something nearer hides the place, or it lies outside the view. Depths whose
// inverses differ by less than `tolerance` are the same.
double visibility_vote(const ReprojectedViews &views, const Imath::V2d &place, double inverse_z,
                       double tolerance);

} // namespace sparselens
