// Checks whether a rim view shows what the centre view shows, moved according to its position on the lens. A position
// with a wrong sign or axis, or one that is entirely wrong, makes an LDI with ghosts, in which each single sample looks
// valid.
//
// Where a pixel of the view lands in the centre view, it shows the same surface, hence the same colour, or a surface
// that is hidden from the centre; never one in front of what the centre view shows.
#pragma once

#include "../view/view.h"

#include <optional>

namespace sparselens {

// The share, [0, 1], of the pixels of the view that contradict the centre view if the view stands at `position`. A
// pixel in front of the centre view counts as 1, one on the same surface as its relative difference of colour. 0 where
// nothing can be compared. `focal_px` is the focal length in pixels.
double disagreement(const View &centre, const View &view, const Imath::V2d &position, double focal_px);

// A position at which the view agrees clearly better than at its stated one: mirrored, with x and y swapped, or that of
// the centre. Empty where there is none, the normal case.
std::optional<Imath::V2d> better_position(const View &centre, const View &view, double focal_px);

} // namespace sparselens
