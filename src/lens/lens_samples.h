// The aperture as the gather sees it: weighted points on the lens, each with a position inside the pixel through which
// it looks. Any aperture can be described by such a set; the gather knows nothing else about the shape of the lens.
//
// A set of n points integrates over the lens and the pixel at once (four dimensions), evenly in area on both.
#pragma once

#include "lens/aperture.h"

#include <array>
#include <cstddef>
#include <vector>

namespace sparselens {

struct LensSample {
    float x, y;             // displacement of a point of CoC 1, pixels, y down: (u.x, -u.y * pixel aspect)
    float pixel_x, pixel_y; // position in the pixel, [-1/2, 1/2)
    float weight;           // > 0
    // By what the weight is multiplied for R, G and B, and for light from behind focus or in front (LensPoint).
    std::array<float, 3> rgb{1, 1, 1};
    float behind = 1, in_front = 1;
};

// A disc of n >= 1 points of equal weight.
std::vector<LensSample> disc_lens_samples(std::size_t n, double pixel_aspect);

// n >= 1 points of any aperture, of equal weight: those of the disc, moved so that each keeps its share of the light.
std::vector<LensSample> lens_samples(const Aperture &aperture, std::size_t n, double pixel_aspect);

} // namespace sparselens
