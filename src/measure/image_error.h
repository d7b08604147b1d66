// The distance of a picture from its reference: the figures of docs/design.md section 6, over R, G and B.
//
// Let a be the picture and b the reference. Means are taken over the three channels of the compared pixels:
//   psnr             -10 log10 of the mean of (a - b)^2, dB: peak 1; infinite if a = b
//   psnr_tonemapped  the same for tone-mapped values (light.h)
//   psnr_srgb        the same for values limited to [0, 1] and encoded as sRGB, as papers quote it
//   psnr_worst       psnr_tonemapped of the worst 1 % (at least one) of the blocks of 8 x 8 pixels, counted from the
//                    upper left corner; in a region a block has the pixels of that region
//   relmse           mean of (a - b)^2 / (b^2 + 0.01)
//   smape            mean of |a - b| / (|a| + |b| + 0.01), [0, 1)
//   ssim             mean structural similarity (below) of the luma (Rec. 709 weights) of the tone-mapped
//                    channels; a region counts the windows that are centred in it
//   ssim_srgb        the same for the channels of psnr_srgb
//   p99              the smallest |a - b| that at least 99 % of the channel values do not exceed
//   max, max_alpha   the largest |a - b| of the colours, and of A
//   without_noise    the result of error_without_noise() (without_noise.h), if it was measured
// A pixel with a channel (R, G, B or A) that is infinite or NaN in either picture is counted and left out, as is every
// SSIM window that contains it. The figures of an empty set of pixels are NaN.
#pragma once

#include "../base/image.h"
#include "without_noise.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct ErrorFigures {
    double psnr, psnr_tonemapped, psnr_srgb, psnr_worst, relmse, smape, ssim, ssim_srgb, p99, max, max_alpha;
    std::size_t pixels = 0; // compared pixels
    std::size_t nonfinite_image = 0, nonfinite_reference = 0;
    std::optional<ErrorWithoutNoise> without_noise = {}; // if there are two references
};

struct Figure {
    const char *name; // as in reports
    double ErrorFigures::*value;
};

inline constexpr std::array figure_table{Figure{"psnr", &ErrorFigures::psnr},
                                         Figure{"psnr_tonemapped", &ErrorFigures::psnr_tonemapped},
                                         Figure{"psnr_srgb", &ErrorFigures::psnr_srgb},
                                         Figure{"psnr_worst", &ErrorFigures::psnr_worst},
                                         Figure{"relmse", &ErrorFigures::relmse},
                                         Figure{"smape", &ErrorFigures::smape},
                                         Figure{"ssim", &ErrorFigures::ssim},
                                         Figure{"ssim_srgb", &ErrorFigures::ssim_srgb},
                                         Figure{"p99", &ErrorFigures::p99},
                                         Figure{"max", &ErrorFigures::max},
                                         Figure{"max_alpha", &ErrorFigures::max_alpha}};

// R, G, B and A of `image` over the data window of `target`; the corners of the display windows coincide. Pixels
// outside `image` are transparent black. Without a channel A, the pixels inside have A = 1.
// Throws Error, naming `file`, if a channel R, G or B is missing or the display window has another size.
Image rgba_over(const Image &image, const Windows &target, const std::string &file);

// The figures over all pixels, then over the pixels of each of `regions` regions: pixel i belongs to region r < 8 if
// bit r of region_bits[i] is set. Both pictures are as rgba_over() returns them and have the same data window.
std::vector<ErrorFigures> image_error(const Image &image, const Image &reference,
                                      std::span<const std::uint8_t> region_bits = {},
                                      std::size_t regions = 0);

// The structural similarity of two pictures of one channel, with a peak of 1.
//
// Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli, "Image quality assessment: from error visibility to structural
// similarity", 2004: Gaussian window of 11 x 11 pixels, sigma 1.5, weights summing to 1; K1 = 0.01, K2 =
// 0.03; variances and covariance weighted by the same window. Only windows that lie wholly inside the picture
// count. Where the picture is narrower (lower) than 11 pixels, the window is as wide (high) as the picture, with the
// Gaussian centred in it.

// One value per window, in rows from the top left; 1 if the pictures are equal.
struct SsimMap {
    int width = 0, height = 0;
    int centre_x = 0, centre_y = 0; // window (x, y) is centred on pixel (x + centre_x, y + centre_y)
    std::vector<double> values;
};

// `a` and `b` hold width * height values, row by row. The value of a window is NaN if, and only if, it contains a NaN.
SsimMap ssim_map(std::span<const float> a, std::span<const float> b, int width, int height);

// The weights of a window of `size` pixels along one axis.
std::vector<double> ssim_window(int size);

inline constexpr int ssim_window_size = 11;
inline constexpr double ssim_c1 = 0.01 * 0.01, ssim_c2 = 0.03 * 0.03;

} // namespace sparselens
