// Finds the pixels of flat views that mix several surfaces, as deep views tell.
//
// A part of a deep view that covers only some of its pixel also covers only some of the pixels of a flat view that it
// falls on, if nothing in the flat view is nearer. The colour of such a pixel is not its surface's alone: it shows an
// edge, a veil or fog.
#pragma once

#include "warp/images/matched_view.h"

#include <span>
#include <vector>

namespace sparselens {

// Returns [view][pixel]; empty for deep views. Depths whose inverses differ by less than `tolerance` are one surface.
std::vector<std::vector<bool>> find_mixed_pixels(std::span<const PlacedView> views, double tolerance);

} // namespace sparselens
