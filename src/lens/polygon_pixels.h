// Integrals over the part of a polygon that lies in each pixel, exact up to rounding.
//
// Each edge is cut at the edges of pixels. A piece adds the area right of it in its own pixel to that pixel, and whole
// pixels farther right; sums along the rows are then the integrals (Green's theorem, as for drawing outline fonts).
#pragma once

#include "lens/lens_looks.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <span>
#include <vector>

namespace sparselens {

// The integrand: constant + quadratic ((x - centre.x)^2 scale.x^2 + (y - centre.y)^2 scale.y^2).
struct RadialDensity {
    double constant = 1, quadratic = 0;
    Imath::V2d centre{0, 0}, scale{1, 1};
};

// Sets values[row][column] of the pixels of a box (not empty; pixel x spans [x, x + 1]). The corners of the polygon run
// in either direction around it.
void integrate_over_pixels(std::span<const Imath::V2d> polygon, const RadialDensity &density,
                           const Imath::Box2i &box, std::vector<double> &values);

// Area of a polygon: positive if its corners run counter-clockwise with y up.
double signed_area(std::span<const Imath::V2d> polygon);

// Mean of x^2 + y^2 over a polygon whose area is not 0.
double mean_square_radius(std::span<const Imath::V2d> polygon);

// The outline of an aperture as a polygon, before it is squeezed: regular, with straight or bulging sides, inside the
// unit circle; and the part of it that a second circle leaves.

// The corners of the outline, counter-clockwise, y up. Arcs become chords that are at most `tolerance` away from them
// and enclose the same area. The shape must not be a picture.
std::vector<Imath::V2d> aperture_outline(const ApertureShape &shape, double tolerance);

// The part of a convex polygon (counter-clockwise) that lies within 1 of `centre`, arcs as above; empty: there is none.
std::vector<Imath::V2d> within_unit_circle(std::span<const Imath::V2d> polygon, const Imath::V2d &centre,
                                           double tolerance);

} // namespace sparselens
