// The structural similarity of two pictures of one channel, with a peak of 1.
//
// Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli, "Image quality assessment: from error visibility to structural
// similarity", 2004: Gaussian window of 11 x 11 pixels, sigma 1.5, weights summing to 1; K1 = 0.01, K2 =
// 0.03; variances and covariance weighted by the same window. Only windows that lie wholly inside the picture
// count. Where the picture is narrower (lower) than 11 pixels, the window is as wide (high) as the picture, with the
// Gaussian centred in it.
#pragma once

#include <span>
#include <vector>

namespace sparselens {

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
