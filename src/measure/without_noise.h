// How far a picture is from the truth, by two independent references: the mean of (p - a)(p - b), tone-mapped (tone_map.h), over
// R, G and B. Their noise, which an error against either of them contains, is not in it.
#pragma once

#include "../base/image.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

struct ErrorWithoutNoise {
    double mean_square = 0; // below 0 by chance where the error is small; NaN for no pixels
    // What it would deviate by if the picture were the truth, as the references differ (as if their noise were Gaussian, and the same
    // in all channels, which is the worst case).
    double deviation = 0;

    double decibels() const; // of a mean square that is above 0
    bool is_told() const;    // above twice the deviation
    double at_least() const; // decibels: by twice the deviation above the mean square
};

// Of all pixels, then of each region, as image_error() has them. Pixels that are not finite in any of the three are left out.
std::vector<ErrorWithoutNoise> error_without_noise(const Image &image, const Image &first,
                                                   const Image &second,
                                                   std::span<const std::uint8_t> region_bits = {},
                                                   std::size_t regions = 0);

// What other figures compare with. The two have the same data window and R, G, B and A, as rgba_over() returns them.
Image mean_of_references(const Image &first, const Image &second);

} // namespace sparselens
