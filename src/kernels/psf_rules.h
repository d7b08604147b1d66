// How much of a disc lies in a box or in a part of a pixel (lens/psf.h). The disc is a circle where lengths in y are
// divided by the pixel aspect; distances are from its centre.
#pragma once

#include "kernels/types.h"

namespace sparselens::kernels {

inline constexpr double pi = 3.141592653589793;
inline constexpr double smallest_psf_radius = 1e-9; // a smaller disc is a point

// Half the chord at distance d from the centre. (r - d) (r + d) keeps its digits where r^2 - d^2 cancels.
template <typename Real>
inline Real half_chord(Real radius, Real d) {
    return sqrt(max(Real(0), (radius - d) * (radius + d)));
}

// The integral of sqrt(r^2 - t^2) from 0 to t.
template <typename Real>
inline Real chord_integral(Real radius, Real t) {
    return (t * half_chord(radius, t) + radius * radius * asin(t / radius)) / 2;
}

// Area of the disc within [0, x] x [0, y], for x, y of either sign: odd in both, so that any rectangle is a sum
// of four.
template <typename Real>
inline Real signed_quadrant_area(Real radius, Real x, Real y) {
    const Real across = min(abs(x), radius), down = min(abs(y), radius);
    const Real turned = (x < 0) == (y < 0) ? Real(1) : Real(-1);
    if (across * across + down * down <= radius * radius) return turned * across * down;
    const Real start = half_chord(radius, down); // from there on, the arc limits it
    return turned * (start * down + chord_integral(radius, across) - chord_integral(radius, start));
}

// Area of the disc within a box whose sides lie at these distances from the centre.
template <typename Real>
inline Real area_between(Real radius, Real x0, Real y0, Real x1, Real y1) {
    const Real area = signed_quadrant_area(radius, x1, y1) - signed_quadrant_area(radius, x0, y1) -
                      signed_quadrant_area(radius, x1, y0) + signed_quadrant_area(radius, x0, y0);
    return max(Real(0), area);
}

// Area between an arc of at most a quarter turn and its chord: r^2 (asin s - s sqrt(1 - s^2)), s = chord / 2r.
// It is s^3 times a series in s^2. The long polynomial interpolates that series at the Chebyshev nodes of s^2 in
// [0, 1/2] (relative error 1e-9). The short one is its Taylor polynomial: pieces within a pixel are no longer than
// sqrt(2), so from a radius of 2.5 on its error is below 3e-7.
inline double segment_area(double radius, double chord_squared) {
    const double t = chord_squared / (4 * radius * radius);
    double sum = 5.0 / 72;
    if (radius < 2.5) {
        sum = 0.265231504305 * t - 0.36436085167;
        sum = sum * t + 0.297929303522;
        sum = sum * t - 0.0786869562199;
        sum = sum * t + 0.0636289091899;
        sum = sum * t + 0.0460867824798;
        sum = sum * t + 0.0697332580261;
        sum = sum * t + 0.107131328214;
        sum = sum * t + 0.200000176699;
        sum = sum * t + 0.666666666224;
    } else {
        sum = sum * t + 3.0 / 28;
        sum = sum * t + 1.0 / 5;
        sum = sum * t + 2.0 / 3;
    }
    return radius * radius * t * sqrt(t) * sum;
}

// The first cell, and the one after the last, of [low, high) that lie within a distance of `centre`, in part or whole.
// The numbers that are cast are not negative, so that the cast rounds down.
inline int floor_within(double x, int low, int high) {
    return low + int(max(0.0, min(x - low, double(high - low))));
}
inline int first_within(double centre, double distance_, int low, int high) {
    return floor_within(centre - distance_, low, high);
}
inline int end_within(double centre, double distance_, int low, int high) {
    return floor_within(centre + distance_ + 1, low, high);
}

// The part of a row on one side of the centre's row: between `low` and `high` <= radius, where half the chord is
// `outer` and `inner`. It fills the columns from -inner to inner; beyond them the arc falls from (inner, high) to
// (outer, low).
struct Band {
    double low, high, outer, inner;
};

// The part of the row between `top` and `bottom`, with half chords `at_top` and `at_bottom`, that lies above the
// centre, or below. The row that holds the centre has both.
inline Band band_of(bool is_above, double top, double bottom, double at_top, double at_bottom,
                    double radius) {
    const bool both = top < 0 && bottom > 0;
    Band band;
    band.low = both ? 0.0 : min(is_above ? -bottom : top, radius);
    band.high = min(is_above ? -top : bottom, radius);
    band.outer = both ? radius : is_above ? at_bottom : at_top;
    band.inner = is_above ? at_top : at_bottom;
    return band;
}

// The area between a piece of the arc and the band's lower edge.
inline double area_under(double from_x, double from_y, double to_x, double to_y, double low, double radius) {
    const double run = max(0.0, to_x - from_x), fall = from_y - to_y;
    return run * ((from_y + to_y) / 2 - low) + segment_area(radius, run * run + fall * fall);
}

} // namespace sparselens::kernels
