// How much a pixel of a view counts in the mean of what falls into a pixel of the centre view.
#pragma once

#include <array>

namespace sparselens {

// (dx, dy): where it falls, pixels from the middle. A mean of pixels that lie apart is blurred, hence those near the
// middle count more.
//
// A Gaussian: exp(x) = exp(x / 8)^8, and exp(x / 8) by its Taylor series, whose rest is below rounding where -2.8 < x <= 0.
// Additions and multiplications alone, which a GPU does alike (gpu/warp/warp_data.glsl).
inline double nearness(double dx, double dy) {
    constexpr double spread = 0.3; // pixels; less is sharper, more averages more noise away
    constexpr std::array coefficients{1.0,
                                      1.0,
                                      1.0 / 2,
                                      1.0 / 6,
                                      1.0 / 24,
                                      1.0 / 120,
                                      1.0 / 720,
                                      1.0 / 5040,
                                      1.0 / 40320,
                                      1.0 / 362880,
                                      1.0 / 3628800,
                                      1.0 / 39916800,
                                      1.0 / 479001600,
                                      1.0 / 6227020800};
    const double t = (dx * dx + dy * dy) * (-0.5 / (spread * spread) / 8);
    double e = coefficients.back();
    for (std::size_t k = coefficients.size() - 1; k-- > 0;) e = e * t + coefficients[k];
    e *= e;
    e *= e;
    return e * e;
}

} // namespace sparselens
