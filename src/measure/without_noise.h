// How far a picture is from the truth, measured with two independent references: the mean of (p - a)(p - b),
// tone-mapped (light.h), over R, G and B. It is free of the references' noise, which an error against either of them
// contains.
#pragma once

#include "../base/image.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

struct ErrorWithoutNoise {
    double mean_square = 0; // below 0 by chance if the error is small; NaN if there are no pixels
    // Its standard deviation if the picture were the truth, from the difference of the references (as if their noise
    // were Gaussian, and the same in all channels, which is the worst case).
    double deviation = 0;

    double decibels() const; // requires a mean square above 0
    bool is_told() const;    // whether it exceeds twice the deviation
    double at_least() const; // decibels of the mean square plus twice the deviation
};

// The error over all pixels, then over each region, like image_error(). Pixels that are not finite in any of the three
// pictures are left out.
std::vector<ErrorWithoutNoise> error_without_noise(const Image &image, const Image &first,
                                                   const Image &second,
                                                   std::span<const std::uint8_t> region_bits = {},
                                                   std::size_t regions = 0);

// The reference for other figures. Both have the same data window and R, G, B and A, as rgba_over() returns them.
Image mean_of_references(const Image &first, const Image &second);

} // namespace sparselens
