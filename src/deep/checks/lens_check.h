// Finds mixed-up units, such as millimetres for scene units or centimetres for metres, by the lens and the view
// positions.
#pragma once

#include "../../lens/thin_lens.h"
#include "deep/packed_view.h"

#include <span>
#include <vector>

namespace sparselens {

// The largest circle of confusion of the depths of a view, in pixels; 0 if the view shows nothing.
double largest_circle_of_confusion(std::span<const float> depths, const ThinLens &lens);

// Whether the lens leaves the picture as it is, because the blur is narrower than a pixel everywhere. A unit that is
// wrong by 100 or 1000 does that to nearly every shot. A lens of radius 0 is meant to do it, and does not count.
bool blurs_nothing(double largest_coc, const ThinLens &lens);

// The views that stand farther than three lens radii from the centre. Such a lens sees nothing from there, and mixed-up
// units differ by ten and more.
std::vector<std::size_t> views_beyond_lens(std::span<const PackedView> views, double lens_radius);

} // namespace sparselens
