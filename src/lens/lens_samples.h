// The aperture as the gather sees it: weighted points on the lens, each with a position inside the pixel through which
// it looks. Such a set can describe any aperture; the gather knows nothing else about the shape of the lens.
//
// A set of n points integrates over the lens and the pixel at once (four dimensions), evenly in area on both.
#pragma once

#include "lens/aperture.h"

#include <Imath/ImathVec.h>

#include <cstddef>
#include <vector>

namespace sparselens {

struct LensSample {
    float x, y;             // displacement of a point of CoC 1, pixels, y down: (u.x, -u.y * pixel aspect)
    float pixel_x, pixel_y; // position in the pixel, [-1/2, 1/2); everything seen is moved by it
    float weight;           // > 0
    // Factors on the weight for R, G and B, and for light from behind focus or in front (LensPoint).
    ColourFactors rgb = no_factors, behind = no_factors, in_front = no_factors;

    bool has_rims() const { return behind != no_factors || in_front != no_factors; }
    bool counts_alike() const { return rgb == no_factors && !has_rims(); }
};

// The positions in the pixel of a set of n points, [0, 1); the first is the middle.
//
// A sample of CoC c is seen at c u + p, by lens point u and the place p in the pixel. For a set of n points to show a
// disc evenly, those sums have to be even for each c, and no sequence is known that does this. Neighbours on the spiral
// of lens points (lens_points.h) are 8, 13, 21 ... points apart; if these steps bring p back to nearly the same place,
// the points come in clumps. Here positions follow each other by the same step modulo a pixel. For the numbers of
// points of final quality, up to 32 pixels of CoC, that step is the best of a thousand random ones, by the squared
// error of pixels in discs (tests/lens/lens_samples_test.cpp computes it slowly), and for 384 points the best
// of the first six of these on test scenes. It leaves 0.6 to 0.9 of the error of low_discrepancy_2d(), which all other
// numbers of points use.
std::vector<Imath::V2d> pixel_positions(std::size_t n);

// A disc of n >= 1 points of equal weight.
std::vector<LensSample> disc_lens_samples(std::size_t n, double pixel_aspect);

// n >= 1 points of any aperture, of equal weight: the points of the disc, moved so that each keeps its share of the
// light.
std::vector<LensSample> lens_samples(const Aperture &aperture, std::size_t n, double pixel_aspect);

} // namespace sparselens
