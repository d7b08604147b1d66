// The parts of the difference evaluator FLIP (flip.h): its colour spaces, its filters and its two errors. Constants are
// those of the paper. flip.cpp and its slow reference share them; not for use elsewhere.
#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sparselens {

// For a viewer at 0.7 m from a screen that is 3840 pixels and 0.7 m wide.
inline constexpr double flip_pixels_per_degree = 3840 * 3.14159265358979323846 / 180;

// Converts linear Rec. 709 to CIE XYZ, relative to the white of D65, so that white is 1, 1, 1 in both.
inline Imath::V3d flip_xyz(const Imath::V3d &rgb) {
    const auto weighed = [&](double r, double g, double b) { return r * rgb.x + g * rgb.y + b * rgb.z; };
    const double x = weighed(0.4123907993, 0.3575843394, 0.1804807884),
                 y = weighed(0.2126390059, 0.7151686788, 0.0721923154),
                 z = weighed(0.0193308187, 0.1191947798, 0.9505321522);
    return {x / 0.9504559270, y, z / 1.0890577508};
}
inline Imath::V3d flip_rgb(const Imath::V3d &xyz) {
    const double x = xyz.x * 0.9504559270, y = xyz.y, z = xyz.z * 1.0890577508;
    return {3.2409699419 * x - 1.5373831776 * y - 0.4986107603 * z,
            -0.9692436363 * x + 1.8759675015 * y + 0.0415550574 * z,
            0.0556300797 * x - 0.2039769589 * y + 1.0569715142 * z};
}

// YCxCz: L*a*b* without its cube roots, a space in which the eye's filters are linear. Luma, red-green, blue-yellow.
inline Imath::V3d flip_opponent(const Imath::V3d &rgb) {
    const Imath::V3d w = flip_xyz(rgb);
    return {116 * w.y - 16, 500 * (w.x - w.y), 200 * (w.y - w.z)};
}
inline Imath::V3d flip_rgb_of_opponent(const Imath::V3d &opponent) {
    const double y = (opponent.x + 16) / 116;
    return flip_rgb({y + opponent.y / 500, y, y - opponent.z / 200});
}

// L*a*b* of linear RGB in [0, 1]; a and b are reduced in the dark (Hunt's effect).
inline Imath::V3d flip_lab(const Imath::V3d &rgb) {
    const auto root = [](double t) {
        constexpr double d = 6.0 / 29;
        return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
    };
    const Imath::V3d w = flip_xyz(rgb);
    const double x = root(w.x), y = root(w.y), z = root(w.z), lightness = 116 * y - 16;
    return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

// The distance of two colours of flip_lab(), for large distances: HyAB to the power 0.7.
inline double flip_distance(const Imath::V3d &a, const Imath::V3d &b) {
    return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), 0.7);
}

// [0, 1]. Distances up to 0.4 of the largest one (that between green and blue) take up 0.95 of the range.
inline double flip_colour_error(const Imath::V3d &a, const Imath::V3d &b) {
    static const double largest = flip_distance(flip_lab({0, 1, 0}), flip_lab({0, 0, 1}));
    const double distance = flip_distance(a, b), knee = 0.4 * largest;
    return distance < knee ? 0.95 * distance / knee : 0.95 + 0.05 * (distance - knee) / (largest - knee);
}

// How much an edge and a point stand out in a picture; the error compares both pictures.
struct FlipFeatures {
    double edge = 0, point = 0;
};
inline double flip_feature_error(const FlipFeatures &a, const FlipFeatures &b) {
    return std::sqrt(std::max(std::abs(a.edge - b.edge), std::abs(a.point - b.point)) / std::sqrt(2.0));
}

// Differences of features amplify the difference of colours.
inline double flip_error(double colour, double feature) { return std::pow(colour, 1 - feature); }

// The contrast sensitivity of an opponent channel at a viewing distance: a sum of two Gaussians a sqrt(pi / b)
// exp(-pi^2 x^2 / b), with x in degrees.
struct FlipGaussian {
    double a, b;
    double operator()(double squared_degrees) const {
        constexpr double pi = 3.14159265358979323846;
        return a * std::sqrt(pi / b) * std::exp(-pi * pi * squared_degrees / b);
    }
};
inline constexpr FlipGaussian flip_luma{1, 0.0047}, flip_red_green{1, 0.0053}, flip_blue_yellow{34.1, 0.04},
    flip_blue_yellow_wide{13.5, 0.025};

// In pixels; each filter reaches three standard deviations of the widest one.
inline int flip_filter_reach() {
    return int(std::ceil(3 * std::sqrt(0.04 / 2) / 3.14159265358979323846 * flip_pixels_per_degree));
}
inline double flip_feature_deviation() { return 0.5 * 0.082 * flip_pixels_per_degree; }
inline int flip_feature_reach() { return int(std::ceil(3 * flip_feature_deviation())); }

} // namespace sparselens
