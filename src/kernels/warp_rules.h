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

// The weights of the samples of a surface where views of it are missing (warp/coverage.h). For weights w and offsets x:
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

// The visibility vote (warp/coverage.h). `there`, `past`, `through`: the Votes. covers(): what a sample covers of what
// is `left` of its pixel. coverage_by_votes(): half by the majority of the views, half by the mean of what they show;
// `shown`: how much of their own pixels the samples of the surface cover on average.
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

// Whether views of a block of pixels agree (warp/photo_consistency.h).
inline constexpr int photo_block = 8; // pixels wide and high

// Bounds a value, so that one bright pixel does not decide for its block.
template <typename Real>
inline Real bounded(Real v) {
    return v / (1 + abs(v));
}

// The sums over the pixels of a block so far.
struct PhotoBlock {
    double difference, variation; // sums of squares over channels
    double coc;                   // sum of |CoC|
    double pixels;
    // Sums over each sample of a rim view and each channel: of the difference, and of how the difference changes with
    // the image depth, which is the gradient along the direction in which the image moves.
    double change2, change_difference, difference2, values;
};

inline void add_motion(PhotoBlock &block, double difference, double change) {
    block.change2 += change * change;
    block.change_difference += change * difference;
    block.difference2 += difference * difference;
    block.values += 1;
}
inline void add_channel(PhotoBlock &block, double difference, double variation) {
    block.difference += difference * difference;
    block.variation += variation * variation;
}
inline void add_pixel(PhotoBlock &block, double coc) {
    block.coc += coc;
    block.pixels += 1;
}

inline constexpr double focus_px = 2; // CoC up to which a surface counts as in focus

// Whether views differ by more than noise.
inline bool views_differ(PhotoBlock block) {
    const double least_ratio = 3;         // noise alone gives up to 1.6, edges of texture up to 2
    const double least_difference = 1e-5; // mean square, tone-mapped: less is not seen
    return block.difference > least_ratio * block.variation + least_difference * block.pixels;
}

// Returns how far from the surface, in pixels of disparity, an image depth lies that explains much of the difference
// between the views, by linear regression; 0 if no depth does.
inline double explaining_motion(PhotoBlock block) {
    const double least_explained = 0.5; // share of the squared differences; noise alone gives a hundredth
    const double least_change = 1e-5;   // mean square for each pixel of depth; less tells nothing
    if (!(block.change2 > least_change * block.values)) return 0;
    const double moved = block.change_difference / block.change2, explained = moved * block.change_difference;
    return explained >= least_explained * block.difference2 ? abs(moved) : 0.0;
}

// The unit of the motions of images, in pixels of disparity, if `across` pixels, across and down, become one
// pixel of the picture. An image is worth finding if it moves by at least a quarter of the unit: between opposite
// views, by a quarter of a pixel of the picture.
inline double motion_unit(int across) { return across > 2 ? 0.5 * double(across) : 1.0; }

// A verdict is a set of these.
inline constexpr uint may_average = 1, differs_slightly = 2, differs_clearly = 4;
inline uint photo_verdict(PhotoBlock block, double unit) { // motion_unit()
    const double least_motion = 0.3 * unit;                // pixels of disparity
    const double clear_motion = 0.5 * unit;                // the same; sharp edges seem to move by less
    const bool differ = views_differ(block), in_focus = block.coc <= focus_px * block.pixels;
    const double moved = explaining_motion(block);
    const uint averages = !differ || in_focus ? may_average : 0u;
    return averages | (differ || moved >= clear_motion ? differs_clearly
                       : moved >= least_motion         ? differs_slightly
                                                       : 0u);
}

} // namespace sparselens::kernels
