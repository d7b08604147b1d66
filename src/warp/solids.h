// Which opaque surfaces are taken to be solid some way behind what is seen of them (Ldi::solid), so that a lens point between
// those of the views does not look through a gap between two of them that no view saw open.
//
// The first sample of a pixel that covers half of it or more is WarpTuning::solid_px thick where no view saw through that
// thickness: every view that looks at the place which lies so much farther away has something nearer there, and in the pixels
// around. Where the surface is smooth within reach, no lens point could look past it, and nothing is said. A pixel of a view that
// shows nothing was seen through. Mirrors and glass, whose depth is that of images, are not solid.
#pragma once

#include "deep/ldi.h"
#include "warp/images/matched_view.h"

#include <span>

namespace sparselens {

// Sets Ldi::solid, which stays empty where nothing is solid. The LDI is made of the views, the first of which is the centre;
// `scale` is R F, above 0.
void find_solids(std::span<const PlacedView> views, double scale, Ldi &ldi);

} // namespace sparselens
