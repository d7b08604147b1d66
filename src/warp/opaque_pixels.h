// What is opaque in the views is opaque in the LDI: there the samples of a pixel let no light through.
//
// The mean of a surface has the mean of its samples' coverage, and the vote of the views takes some more from what the
// centre view does not see. What was behind it in one view lies elsewhere in another, so that the samples which fall into
// one pixel need not add up to a whole one. What the last of them leaves open is filled by what the rim views see past it
// there, at its depth, so that it does not grow; where none sees past it, by its own colour. Where views see past
// everything, as many of them leave it open: elements over nothing have edges that let light through, and keep them.
#pragma once

#include "deep/ldi.h"
#include "warp/reprojected_views.h"

namespace sparselens {

// `ldi` is warped from the views; `tolerance`: of 1 / z, within one surface. In the frame of the centre view, pixels stay as
// they are that let light through there; beyond it, those of which no rim view can tell.
void keep_opaque(const ReprojectedViews &views, double tolerance, Ldi &ldi);

} // namespace sparselens
