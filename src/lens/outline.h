// The outline of an aperture as a polygon, before it is squeezed: regular, with straight or bulging sides, inside the
// unit circle; and the part of it that a second circle leaves.
#pragma once

#include "lens/aperture_shape.h"

#include <Imath/ImathVec.h>

#include <span>
#include <vector>

namespace sparselens {

// The corners of the outline, counter-clockwise, y up. Arcs become chords that are at most `tolerance` away from them
// and enclose the same area. The shape must not be a picture.
std::vector<Imath::V2d> aperture_outline(const ApertureShape &shape, double tolerance);

// The part of a convex polygon (counter-clockwise) that lies within 1 of `centre`; empty if there is none.
std::vector<Imath::V2d> within_unit_circle(std::span<const Imath::V2d> polygon, const Imath::V2d &centre,
                                           double tolerance);

} // namespace sparselens
