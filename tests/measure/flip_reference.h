// FLIP in the form of the paper, slow and simple: each filter is a square of weights applied to each pixel. Colour
// spaces and errors come from measure/flip_terms.h.
#pragma once

#include "measure/flip_terms.h"

#include <functional>

namespace sparselens {

struct PlainRgb {
    int width, height;
    std::vector<Imath::V3d> pixels; // in [0, 1]

    const Imath::V3d &at(int x, int y) const {
        return pixels[std::size_t(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1))];
    }
};

// The weighted sum of `value` over the square around (x, y). The positive weights add up to 1, and the negative ones,
// if any, to -1.
inline double flip_filtered_plainly(int x, int y, int reach, const std::function<double(int, int)> &weight,
                                    const std::function<double(int, int)> &value) {
    double positive = 0, negative = 0, of_positive = 0, of_negative = 0;
    for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i) {
            const double w = weight(i, j);
            (w > 0 ? positive : negative) += w;
            (w > 0 ? of_positive : of_negative) += w * value(x + i, y + j);
        }
    return of_positive / positive + (negative < 0 ? of_negative / -negative : 0);
}

inline Imath::V3d flip_lab_plainly(const PlainRgb &picture, int x, int y) {
    Imath::V3d seen;
    for (int channel = 0; channel < 3; ++channel) {
        const auto weight = [&](int i, int j) {
            const double squared = double(i * i + j * j) / (flip_pixels_per_degree * flip_pixels_per_degree);
            if (channel == 0) return flip_luma(squared);
            if (channel == 1) return flip_red_green(squared);
            return flip_blue_yellow(squared) + flip_blue_yellow_wide(squared);
        };
        seen[channel] = flip_filtered_plainly(x, y, flip_filter_reach(), weight, [&](int i, int j) {
            return flip_opponent(picture.at(i, j))[channel];
        });
    }
    Imath::V3d rgb = flip_rgb_of_opponent(seen);
    for (int c = 0; c < 3; ++c) rgb[c] = std::clamp(rgb[c], 0.0, 1.0);
    return flip_lab(rgb);
}

inline FlipFeatures flip_features_plainly(const PlainRgb &picture, int x, int y) {
    const double d = flip_feature_deviation();
    const auto bell = [&](int i, int j) { return std::exp(-(i * i + j * j) / (2 * d * d)); };
    const auto filtered = [&](const std::function<double(int, int)> &weight) {
        return flip_filtered_plainly(x, y, flip_feature_reach(), weight, [&](int i, int j) {
            return (flip_opponent(picture.at(i, j)).x + 16) / 116;
        });
    };
    return {std::hypot(filtered([&](int i, int j) { return i * bell(i, j); }),
                       filtered([&](int i, int j) { return j * bell(i, j); })),
            std::hypot(filtered([&](int i, int j) { return (i * i / (d * d) - 1) * bell(i, j); }),
                       filtered([&](int i, int j) { return (j * j / (d * d) - 1) * bell(i, j); }))};
}

inline double flip_plainly(const PlainRgb &a, const PlainRgb &b, int x, int y) {
    return flip_error(flip_colour_error(flip_lab_plainly(a, x, y), flip_lab_plainly(b, x, y)),
                      flip_feature_error(flip_features_plainly(a, x, y), flip_features_plainly(b, x, y)));
}

} // namespace sparselens
