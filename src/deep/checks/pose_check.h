// Checks whether views stand where they are said to stand. A wrong position makes an LDI with ghosts, in which each
// single sample looks valid. Only a clear finding over many pixels counts: pose_evidence.h says what they tell.
#pragma once

#include "deep/packed_view.h"

#include <cstddef>
#include <optional>
#include <span>

namespace sparselens {

// A position at which the view agrees with the centre view clearly better than at its stated one: mirrored, with x and
// y swapped, that of the centre, or nearer to or farther from the centre. For a view that is said to stand at the centre
// it is any within about `reach`, the distance of the other views; 0: unknown. Empty where there is none, the normal
// case, and where too few pixels tell. `focal_px` is the focal length in pixels.
std::optional<Imath::V2d> better_position(const PackedView &centre, const PackedView &view, double focal_px,
                                          double reach = 0);

// How far the view's axis is turned, degrees to the right and up, where it clearly agrees with the centre view at its stated
// place if it is turned so, and more than at any other place; as cameras are that are aimed at the focus. Empty else.
// `reach` as above.
std::optional<Imath::V2d> turned_by(const PackedView &centre, const PackedView &view, double focal_px,
                                    double reach = 0);

// The first of the views before views[i] that is the same picture, though it is said to stand elsewhere, whence it would
// show the scene otherwise.
std::optional<std::size_t> same_picture(std::span<const PackedView> views, std::size_t i, double focal_px);

// The first of the views before views[i] that is the same picture from the same place: one file given twice.
std::optional<std::size_t> same_picture_and_place(std::span<const PackedView> views, std::size_t i);

// Whether views[0], which has to be the centre, stands at the edge of the others: all of them are to one side of it, and
// they are not equally far from it, or farther than `lens_radius` (0: unknown). Of a single other view nothing is said.
bool first_is_at_the_edge(std::span<const PackedView> views, double lens_radius);

// The view in the middle of all; empty where no view stands there.
std::optional<std::size_t> view_in_the_middle(std::span<const PackedView> views);

} // namespace sparselens
