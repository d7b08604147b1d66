// Points on the lens, from which views are rendered and rays start. They lie in the unit disc, y up. Every set covers
// the area evenly and has a fixed order.
#pragma once

#include <Imath/ImathVec.h>

#include <vector>

namespace sparselens {

// Point k of n on the rim: (cos 2 pi k/n, sin 2 pi k/n).
std::vector<Imath::V2d> rim_lens_points(int n);

// n points spread over the disc on a golden-angle spiral (H. Vogel, "A better way to construct the sunflower
// head", 1979). A single point is the centre.
std::vector<Imath::V2d> spiral_lens_points(int n);

// Maps the unit square to the unit disc, preserving the proportions of areas and keeping neighbours together
// (P. Shirley and K. Chiu, "A low distortion map between disk and square", 1997).
Imath::V2d disc_point(const Imath::V2d &square);

// The share of the lens points that one moment of a shutter takes.

struct LensShare {
    int moment = 0;  // from 0
    int moments = 1; // of the shutter, at least 1; 1: the moment takes all lens points
};

} // namespace sparselens
