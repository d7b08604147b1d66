// Which pixels of flat views mix what several surfaces show, as deep views tell.
//
// A part of a deep view that covers some of its pixel covers some of the pixels of a flat view over which that pixel lies there, if
// nothing in the flat view is nearer. The colour of such a pixel is not that of its surface alone: an edge, a veil, fog.
#pragma once

#include "warp/images/matched_view.h"

#include <span>
#include <vector>

namespace sparselens {

// [view][pixel] of the flat views; of deep ones nothing. Depths whose inverses differ by less than `tolerance` are one surface.
std::vector<std::vector<bool>> find_mixed_pixels(std::span<const PlacedView> views, double tolerance);

} // namespace sparselens
