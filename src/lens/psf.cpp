#include "lens/psf.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

// Half the chord at distance d from the centre. (r - d) (r + d) keeps its digits where r^2 - d^2 cancels.
template <typename Real>
Real half_chord(Real radius, Real d) {
    return std::sqrt(std::max(Real(0), (radius - d) * (radius + d)));
}

// Area of the disc within [0, x] x [0, y], for x, y of either sign: odd in both, so that any rectangle is a sum
// of four.
template <typename Real>
Real signed_quadrant_area(Real radius, Real x, Real y) {
    const Real across = std::min(std::abs(x), radius), down = std::min(std::abs(y), radius);
    const Real sign = (x < 0) == (y < 0) ? 1 : -1;
    if (across * across + down * down <= radius * radius) return sign * across * down;
    const Real start = half_chord(radius, down); // from there on the arc is what limits it
    const auto integral = [&](Real t) {          // of sqrt(r^2 - t^2)
        return (t * half_chord(radius, t) + radius * radius * std::asin(t / radius)) / 2;
    };
    return sign * (start * down + integral(across) - integral(start));
}

// The share of the disc's light that falls into a box whose sides lie at these distances from the centre.
template <typename Real>
Real share_between(Real radius, Real x0, Real y0, Real x1, Real y1) {
    const Real area = signed_quadrant_area(radius, x1, y1) - signed_quadrant_area(radius, x0, y1) -
                      signed_quadrant_area(radius, x1, y0) + signed_quadrant_area(radius, x0, y0);
    return std::max(Real(0), area) / (std::numbers::pi_v<Real> * radius * radius);
}

// Area between an arc of at most a quarter turn and its chord: r^2 (asin s - s sqrt(1 - s^2)), s = chord / 2r.
// Its series in s is s^3 times one in s^2. The long one is interpolated at the Chebyshev nodes of s^2 in [0, 1/2]
// (relative error 1e-9), the short one is Taylor's: pieces within a pixel are no longer than sqrt(2), so from a
// radius of 2.5 on its error is below 3e-7.
constexpr double short_series_from = 2.5;
constexpr std::array<double, 4> short_series{2.0 / 3, 1.0 / 5, 3.0 / 28, 5.0 / 72};
constexpr std::array<double, 10> long_series{
    0.666666666224,  0.200000176699,   0.107131328214, 0.0697332580261, 0.0460867824798,
    0.0636289091899, -0.0786869562199, 0.297929303522, -0.36436085167,  0.265231504305};

template <std::size_t Length>
double segment_area(double radius, double chord_squared, const std::array<double, Length> &series) {
    const double t = chord_squared / (4 * radius * radius);
    double sum = 0;
    for (std::size_t i = Length; i-- > 0;) sum = sum * t + series[i];
    return radius * radius * t * std::sqrt(t) * sum;
}

double segment_area(double radius, double chord_squared) {
    return radius < short_series_from ? segment_area(radius, chord_squared, long_series)
                                      : segment_area(radius, chord_squared, short_series);
}

// Floor of x, kept within two bounds. What is cut off is positive, so that the cast rounds down.
int floor_within(double x, int low, int high) {
    return low + int(std::clamp(x - low, 0.0, double(high - low)));
}

} // namespace

double psf_share(const Psf &psf, const Imath::Box2d &box) {
    if (psf.radius < smallest_psf_radius) return box.intersects(psf.centre) ? 1 : 0;
    const Imath::V2d low = box.min - psf.centre, high = box.max - psf.centre;
    return share_between(psf.radius, low.x, low.y / psf.pixel_aspect, high.x, high.y / psf.pixel_aspect);
}

double psf_weight(const Psf &psf, int x, int y) {
    if (psf.radius < smallest_psf_radius)
        return std::floor(psf.centre.x) == x && std::floor(psf.centre.y) == y ? 1 : 0;
    const long double left = x - (long double)psf.centre.x, aspect = psf.pixel_aspect;
    const long double top = (y - (long double)psf.centre.y) / aspect;
    return double(share_between((long double)psf.radius, left, top, left + 1, top + 1 / aspect));
}

// The part of a row on one side of the centre's row, distances from the centre (in units of a pixel's width):
// between `low` and `high` <= radius, where half the chord is `outer` and `inner`. Columns are full of it from
// -inner to inner; from there the arc falls from (inner, high) to (outer, low).
struct PsfRows::Band {
    double low = 0, high = 0, outer = 0, inner = 0;
};

PsfRows::PsfRows(const Psf &psf, const Imath::Box2i &box)
    : psf_(psf), box_(box), point_(psf.radius < smallest_psf_radius),
      area_to_weight_(1 / (std::numbers::pi * psf.radius * psf.radius)) {
    assert(box.max.x - box.min.x < max_size && box.max.y - box.min.y < max_size);
    const double radius = point_ ? 0 : psf.radius, high = radius * psf.pixel_aspect;
    const int bottom = box.max.y + 1;
    rows_ = {floor_within(psf.centre.y - high, box.min.y, bottom),
             floor_within(psf.centre.y + high + 1, box.min.y, bottom)};
    columns_ = columns_within(radius);
    if (columns_.begin >= columns_.end) rows_.end = rows_.begin;
    if (point_ || rows_.begin >= rows_.end) return;
    for (int x = columns_.begin; x <= columns_.end; ++x)
        height_[std::size_t(x - box.min.x)] = half_chord(radius, std::abs(x - psf.centre.x));
    for (int y = rows_.begin; y <= rows_.end; ++y)
        width_[std::size_t(y - box.min.y)] =
            half_chord(radius, std::abs(y - psf.centre.y) / psf.pixel_aspect);
}

// Those of the box that lie within a distance of the centre, in part or whole.
PsfRows::Span PsfRows::columns_within(double distance) const {
    const int right = box_.max.x + 1;
    return {floor_within(psf_.centre.x - distance, box_.min.x, right),
            floor_within(psf_.centre.x + distance + 1, box_.min.x, right)};
}

// What the arc cuts off the columns from `column` outwards (Direction 1: to the right).
template <int Direction>
void PsfRows::add_arc(const Band &band, int column, double *weights) const {
    const auto edge_before = [](int x) { return Direction > 0 ? x : x + 1; };
    const auto distance = [&](int edge) { return Direction * (edge - psf_.centre.x); };
    const auto arc_at = [&](int edge) {
        return std::clamp(height_[std::size_t(edge - box_.min.x)], band.low, band.high);
    };
    double x = band.inner, y = band.high;
    if (const int edge = edge_before(column); distance(edge) > x) x = distance(edge), y = arc_at(edge);
    for (; x < band.outer && column >= columns_.begin && column < columns_.end; column += Direction) {
        const int edge = edge_before(column + Direction);
        const double end_x = std::min(distance(edge), band.outer), end_y = arc_at(edge);
        const double run = std::max(0.0, end_x - x), fall = y - end_y;
        const double area =
            run * ((y + end_y) / 2 - band.low) + segment_area(psf_.radius, run * run + fall * fall);
        weights[column - box_.min.x] += area_to_weight_ * area;
        x = end_x;
        y = end_y;
    }
}

void PsfRows::add_band(const Band &band, double *weights) const {
    const double height = area_to_weight_ * (band.high - band.low);
    const Span columns = columns_within(band.inner);
    const double left = psf_.centre.x - band.inner, right = psf_.centre.x + band.inner;
    const int first = columns.begin, last = columns.end - 1;
    const auto add = [&](int x, double share) { weights[x - box_.min.x] += height * share; };
    const auto full_share = [&](int x) { return std::min(x + 1.0, right) - std::max(double(x), left); };
    if (first <= last) add(first, full_share(first));
    for (int x = first + 1; x < last; ++x) add(x, 1);
    if (first < last) add(last, full_share(last));
    if (right < columns_.end) add_arc<1>(band, std::max(columns.end - 1, columns_.begin), weights);
    if (left > columns_.begin) add_arc<-1>(band, std::min(columns.begin, columns_.end - 1), weights);
}

PsfRows::Span PsfRows::row(int y, double *weights) const {
    if (point_) {
        weights[columns_.begin - box_.min.x] = 1;
        return columns_;
    }
    // Edges of the row, in units of a pixel's width. The row that holds the centre is two bands.
    const double radius = psf_.radius;
    const double top = (y - psf_.centre.y) / psf_.pixel_aspect,
                 bottom = (y + 1 - psf_.centre.y) / psf_.pixel_aspect;
    const double at_top = width_[std::size_t(y - box_.min.y)],
                 at_bottom = width_[std::size_t(y - box_.min.y) + 1];
    const bool above = top<0, below = bottom> 0;
    const Span columns = columns_within(above && below ? radius : above ? at_bottom : at_top);
    std::fill(weights + (columns.begin - box_.min.x), weights + (columns.end - box_.min.x), 0.0);
    if (above && below) {
        add_band({0, std::min(-top, radius), radius, at_top}, weights);
        add_band({0, std::min(bottom, radius), radius, at_bottom}, weights);
    } else if (above) {
        add_band({std::min(-bottom, radius), std::min(-top, radius), at_bottom, at_top}, weights);
    } else {
        add_band({std::min(top, radius), std::min(bottom, radius), at_top, at_bottom}, weights);
    }
    return columns;
}

} // namespace sparselens
