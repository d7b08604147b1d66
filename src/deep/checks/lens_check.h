// What lenses and the places of views say of units that were mixed up: millimetres for scene units, centimetres for metres.
#pragma once

#include "../../lens/thin_lens.h"
#include "deep/packed_view.h"

#include <span>
#include <vector>

namespace sparselens {

// The largest circle of confusion of the depths of a view, pixels; 0 where it shows nothing.
double largest_circle_of_confusion(std::span<const float> depths, const ThinLens &lens);

// Whether such a lens leaves a picture as it is: the blur is narrower than a pixel everywhere. A unit that is wrong by 100 or
// 1000 does that to nearly every shot; a lens of radius 0 is meant to, and does not count.
bool blurs_nothing(double largest_coc, const ThinLens &lens);

// The views that stand farther from the centre than three radii of the lens. Nothing that such a lens sees is seen from there,
// and units that are mixed up differ by ten and more.
std::vector<std::size_t> views_beyond_lens(std::span<const PackedView> views, double lens_radius);

} // namespace sparselens
