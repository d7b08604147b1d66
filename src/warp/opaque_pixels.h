// Keeps pixels opaque that are opaque in the views: the samples of such a pixel let no light through.
//
// The mean of a surface has the mean of its samples' coverage, and the vote of the views reduces surfaces that the
// centre view does not see. Their background lies elsewhere in another view, so that the samples which fall into one
// pixel need not add up to a whole one. The light that rim views see past the last sample fills the rest, at the depth
// of that sample, so that the sample does not grow. If no view sees past it, its own colour fills the rest. If views
// see past everything, that share of them leaves the rest open: elements over nothing keep edges that let light
// through.
#pragma once

#include "deep/ldi.h"
#include "warp/reprojected_views.h"

namespace sparselens {

// `ldi` is warped from the views; `tolerance`: of 1 / z, within one surface. Pixels that let light through in the
// centre view stay as they are; beyond its frame, pixels about which no rim view can tell.
void keep_opaque(const ReprojectedViews &views, double tolerance, Ldi &ldi);

} // namespace sparselens
