// How values of light are judged: luminance, the tone mapping with which pictures are compared (v / (1 + v), then
// gamma 1/2.2), the code values of sRGB (IEC 61966-2-1), and the limits of full and of no coverage.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

// Weights of R, G and B (Rec. 709).
inline constexpr std::array luma_weights{0.2126, 0.7152, 0.0722};

// Maps scene-linear [0, inf) to [0, 1). Negative values (ringing filters, out-of-gamut colours) count as black, as a
// display shows them.
inline double tone_mapped(double v) {
    const double positive = std::max(v, 0.0);
    return std::pow(positive / (1 + positive), 1 / 2.2);
}

inline double srgb_encoded(double v) {
    return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}
inline double srgb_decoded(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

// Whether a sample hides what is behind it. The last value of half below 1 is rounding, not a gap.
inline bool is_opaque(float alpha) { return alpha >= 0.9995f; }
// A pixel shows a sample if at least this share of the sample shows; a smaller share means that something is in front.
inline constexpr float half_covered = 0.5f;
// Whether light gets through. Less than 1/2048 of a pixel left over is rounding.
inline bool lets_through(double transmittance) { return transmittance >= 1.0 / 2048; }

// Whether half rounds the coverage to 1; its last step below 1 is 2^-11. When samples are merged, smaller coverage
// keeps the samples behind it, because a lamp shines through even the last step.
inline bool is_one_in_half(float alpha) { return alpha >= 1 - 0x1p-12f; }

// Tolerance for one pixel in two files: the filter, half and a renderer's compression of deep samples (by 0.01) may
// make its coverage differ.
inline constexpr double coverage_rounding = 1.0 / 64;
inline bool is_same_coverage(double a, double b) {
    return a - b <= coverage_rounding && b - a <= coverage_rounding;
}

} // namespace sparselens
