// The rules by which views become an LDI (warp/, gpu/warp).
#pragma once

#include "kernels/types.h"

namespace sparselens::kernels {

// ViewMapping (view/view_mapping.h), along one axis: p = at_infinity(q) + parallax(q) / z, and back.
inline double at_infinity(double q, double unzoom, double offset) { return q * unzoom + offset; }
inline double parallax(double q, double step_, double approach) { return step_ - q * approach; }
inline double scale_in_view(double unzoom, double approach, double inverse_z) {
    return unzoom - approach * inverse_z;
}
inline double place_in_view(double p, double offset, double step_, double inverse_z, double scale) {
    return (p - offset - step_ * inverse_z) / scale;
}

// Whether a position lies in pixels `first` to `last`.
inline bool lies_in(double at, int first, int last) { return at >= first && at < last + 1.0; }

// How much a pixel of a view counts in the mean of the pixels that fall into a pixel of the centre view. It lies at
// (dx, dy) from the middle of that pixel, in pixels. A mean of pixels that lie apart is blurred, so those near the
// middle count more.
//
// A Gaussian: exp(x) = exp(x / 8)^8, and exp(x / 8) by its Taylor series, whose rest is below rounding where -2.8 < x
// <= 0.
inline double nearness(double dx, double dy) {
    const double spread = 0.3; // pixels; less is sharper, more averages more noise away
    const double coefficients[14] = {1.0,
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
                                     1.0 / 6227020800.0};
    const double t = (dx * dx + dy * dy) * (-0.5 / (spread * spread) / 8);
    double e = coefficients[13];
    for (int k = 12; k >= 0; --k) e = e * t + coefficients[k];
    e = e * e;
    e = e * e;
    return e * e;
}

// The weights of the samples of a surface where views of it are missing (warp/balance.h). For weights w and offsets x:
// w (1 - x . b), b = (1 / g^2 + sum of w x x^T)^-1 (sum of w x).
inline constexpr double gradient_to_noise = 8; // g; gains 0.1 to 0.2 dB on fence and yard from 5 to 17
struct Offsets {
    double xx, xy, yy, x, y; // sums
};
inline Offsets no_offsets() {
    Offsets sums;
    sums.xx = 1 / (gradient_to_noise * gradient_to_noise);
    sums.yy = sums.xx;
    sums.xy = 0;
    sums.x = 0;
    sums.y = 0;
    return sums;
}
inline void add_offset(Offsets &sums, double weight, double dx, double dy) {
    sums.xx += weight * dx * dx;
    sums.xy += weight * dx * dy;
    sums.yy += weight * dy * dy;
    sums.x += weight * dx;
    sums.y += weight * dy;
}
// The determinant is above 0: the matrix is positive definite.
inline double balance_x(Offsets s) { return (s.yy * s.x - s.xy * s.y) / (s.xx * s.yy - s.xy * s.xy); }
inline double balance_y(Offsets s) { return (s.xx * s.y - s.xy * s.x) / (s.xx * s.yy - s.xy * s.xy); }
// The factor on a weight, which is at least a hundredth.
inline double balanced_share(double dx, double dy, double by_x, double by_y) {
    return max(0.01, 1 - dx * by_x - dy * by_y);
}

// The mean of the samples of a surface: positions and 1 / z are averaged by weight. The mean of the positions belongs
// to the mean of the colours, so nothing is blurred where colour is linear.
struct Mean {
    double weights, dx, dy, inverse_z, covers; // weights: the sum of the weights in it; covers: alpha
    double merged;                             // view samples in it
};
inline void add_to_mean(Mean &sum, double weight, double merged, double dx, double dy, double inverse_z,
                        double alpha) {
    sum.merged += merged;
    sum.weights += weight;
    sum.dx += weight * dx;
    sum.dy += weight * dy;
    sum.inverse_z += weight * inverse_z;
    sum.covers += weight * alpha;
}
inline void divide_mean(Mean &sum) {
    sum.dx /= sum.weights;
    sum.dy /= sum.weights;
    sum.inverse_z /= sum.weights;
    sum.covers /= sum.weights;
}

// The visibility vote (warp/visibility_vote.h): what a sample covers of what is left of its pixel; the coverage by the
// majority of the views; and half by majority, half by the mean of what they show, where the samples of the surface
// cover `shown` of their own pixels on average.
inline double covers(double alpha, double left) { return alpha < 0 ? 0.0 : left < alpha ? left : alpha; }
inline double bounded_share(double share) { return share < 0 ? 0.0 : share > 1 ? 1.0 : share; }
inline double coverage_by_majority(double there, double past, double through) {
    const double all = there + past;
    return !(all > 0) ? 1.0 : bounded_share(2 * (there + through) / all - 0.5);
}
inline double coverage_by_votes(double there, double past, double through, double shown) {
    const double all = (there + past) * shown, mean = !(all > 0) ? 1.0 : bounded_share(there / all);
    return 0.5 * (coverage_by_majority(there, past, through) + mean);
}

} // namespace sparselens::kernels
