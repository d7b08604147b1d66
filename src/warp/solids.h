// Finds which opaque surfaces count as solid for some distance behind their samples (Ldi::solid), so that a lens point
// between the positions of the views does not look through a gap that no view saw open.
//
// The first sample of a pixel that covers half of it or more is WarpTuning::solid_px thick if no view saw through that
// thickness: every view that looks at the position this much farther away has something nearer there, and in the pixels
// around. If the surface is smooth within reach, no lens point can look past it, and it gets no solid. A pixel of a
// view that shows nothing counts as seen through. Mirrors and glass, which have the depth of images, are not solid.
#pragma once

#include "deep/ldi.h"
#include "warp/images/matched_view.h"

#include <span>

namespace sparselens {

// Sets Ldi::solid, which stays empty if nothing is solid. `ldi` is made of `views`, the centre view first. `scale`: R
// F, above 0.
void find_solids(std::span<const PlacedView> views, double scale, Ldi &ldi);

} // namespace sparselens
