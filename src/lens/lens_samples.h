// The aperture as the gather sees it: weighted points on the lens, each with a place inside the pixel through
// which it looks. Any aperture is such a set; the gather knows nothing else of the lens's shape.
//
// A set with n points integrates over lens and pixel at once (four dimensions), evenly in area on both.
#pragma once

#include <cstddef>
#include <vector>

namespace sparselens {

struct LensSample {
    float x, y;             // displacement of a point of CoC 1, pixels, y down: (u.x, -u.y * pixel aspect)
    float pixel_x, pixel_y; // where in the pixel, [-1/2, 1/2)
    float weight;           // > 0
};

// A disc of n >= 1 equal weights.
std::vector<LensSample> disc_lens_samples(std::size_t n, double pixel_aspect);

} // namespace sparselens
