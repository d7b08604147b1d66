// Structural similarity in the form of the paper (see measure/image_error.h), slow and simple.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

// One window after the other, all its pixels: first the means, then the moments about them. For pictures of at least 11
// x 11.
inline std::vector<double> ssim_reference(std::span<const float> a, std::span<const float> b, int width,
                                          int height) {
    std::vector<double> result;
    for (int y = 0; y + 11 <= height; ++y)
        for (int x = 0; x + 11 <= width; ++x) {
            double weights = 0, mean_a = 0, mean_b = 0, var_a = 0, var_b = 0, covariance = 0;
            const auto each = [&](const auto &use) {
                for (int j = 0; j < 11; ++j)
                    for (int i = 0; i < 11; ++i) {
                        const auto at = std::size_t((y + j) * width + x + i);
                        const double r2 = (i - 5) * (i - 5) + (j - 5) * (j - 5);
                        use(std::exp(-r2 / (2 * 1.5 * 1.5)), double(a[at]), double(b[at]));
                    }
            };
            each([&](double w, double va, double vb) { weights += w, mean_a += w * va, mean_b += w * vb; });
            mean_a /= weights, mean_b /= weights;
            each([&](double w, double va, double vb) {
                var_a += w / weights * (va - mean_a) * (va - mean_a);
                var_b += w / weights * (vb - mean_b) * (vb - mean_b);
                covariance += w / weights * (va - mean_a) * (vb - mean_b);
            });
            result.push_back((2 * mean_a * mean_b + 1e-4) * (2 * covariance + 9e-4) /
                             ((mean_a * mean_a + mean_b * mean_b + 1e-4) * (var_a + var_b + 9e-4)));
        }
    return result;
}

} // namespace sparselens
