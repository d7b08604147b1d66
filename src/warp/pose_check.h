// Whether a rim view shows what the centre view shows, moved as its place on the lens says. A place that is wrong by
// a sign, an axis or altogether makes an LDI of ghosts, of which each sample by itself looks sound.
//
// Where a pixel of the view lands in the centre view it shows the same surface, hence the same colour, or one that
// is hidden from the centre; never one in front of what the centre shows.
#pragma once

#include "../view/view.h"

#include <optional>

namespace sparselens {

// The share of the view's pixels, [0, 1], that contradict the centre view if the view stands at `position`: 1 each
// for what lies in front, their relative difference of colour where they show one surface. 0 where nothing can be
// compared. focal_px: focal length in pixels.
double disagreement(const View &centre, const View &view, const Imath::V2d &position, double focal_px);

// A place at which the view agrees clearly better than where it is said to stand: its mirror images, x and y swapped,
// the centre's own. Empty where there is none, as it should be.
std::optional<Imath::V2d> better_position(const View &centre, const View &view, double focal_px);

} // namespace sparselens
