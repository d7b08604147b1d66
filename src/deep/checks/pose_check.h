// Checks whether views stand where they are said to stand. A wrong position makes an LDI with ghosts, in which each
// single sample looks valid. Only a clear finding over many pixels counts; pose_check.cpp explains what they show.
#pragma once

#include "deep/view_samples.h"

#include <cstddef>
#include <optional>
#include <span>

namespace sparselens {

// A position at which the view agrees with the centre view clearly better than at its stated one: mirrored, with x and
// y swapped, at the centre, or nearer to or farther from the centre. For a view that is said to stand at the centre it
// is any position within about `reach`, the distance of the other views; 0: unknown. Empty if there is none, the normal
// case, or if too few pixels tell. `focal_px` is the focal length in pixels.
std::optional<Imath::V2d> better_position(const PackedView &centre, const PackedView &view, double focal_px,
                                          double reach = 0);

// The angle by which the view's axis is turned, in degrees to the right and up, if the view so turned clearly agrees
// with the centre view at its stated position, and better than at any other position. Cameras that are aimed at the
// focus are turned so. Empty otherwise. `reach` as above.
std::optional<Imath::V2d> turned_by(const PackedView &centre, const PackedView &view, double focal_px,
                                    double reach = 0);

// The first view before views[i] with the same picture, though it is said to stand at another position, from which the
// scene would look different.
std::optional<std::size_t> same_picture(std::span<const PackedView> views, std::size_t i, double focal_px);

// The first view before views[i] with the same picture and position: one file given twice.
std::optional<std::size_t> same_picture_and_place(std::span<const PackedView> views, std::size_t i);

// Whether views[0], which has to be the centre, stands at the edge of the others: all of them lie to one side of it,
// and their distances from it differ, or exceed `lens_radius` (0: unknown). False if there is only one other view.
bool first_is_at_the_edge(std::span<const PackedView> views, double lens_radius);

// The view in the middle of all; empty if no view stands there.
std::optional<std::size_t> view_in_the_middle(std::span<const PackedView> views);

} // namespace sparselens
