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

// Area of the disc within [0, x] x [0, y], for x, y of either sign: odd in both, so that any rectangle is a
// sum of four.
long double signed_quadrant_area(long double radius, long double x, long double y) {
    if (x < 0) return -signed_quadrant_area(radius, -x, y);
    if (y < 0) return -signed_quadrant_area(radius, x, -y);
    x = std::min(x, radius);
    y = std::min(y, radius);
    const long double start = half_chord(radius, y); // left of it the disc is higher than y
    if (x <= start) return x * y;
    const auto integral = [&](long double t) { // of sqrt(r^2 - t^2)
        return (t * half_chord(radius, t) + radius * radius * std::asin(t / radius)) / 2;
    };
    return start * y + integral(x) - integral(start);
}

// Area between an arc of at most a quarter turn and its chord: r^2 (asin s - s sqrt(1 - s^2)), s = chord /
// 2r. Its series in s is s^3 times one in s^2, here interpolated at the Chebyshev nodes of s^2 in [0, 1/2]
// (relative error 1e-9).
double segment_area(double radius, double chord_squared) {
    constexpr std::array<double, 10> series{
        0.666666666224, 0.200000176699,   0.107131328214, 0.0697332580261, 0.0460867824798,
        0.063628909190, -0.0786869562199, 0.297929303522, -0.36436085167,  0.265231504305};
    const double t = chord_squared / (4 * radius * radius);
    double sum = 0;
    for (std::size_t i = series.size(); i-- > 0;) sum = sum * t + series[i];
    return radius * radius * t * std::sqrt(t) * sum;
}

bool is_point(const Psf &psf) { return psf.radius < smallest_psf_radius; }

int whole(double x, double low, double high) { return int(std::clamp(x, low, high)); }

} // namespace

double psf_weight(const Psf &psf, int x, int y) {
    if (is_point(psf)) return std::floor(psf.centre.x) == x && std::floor(psf.centre.y) == y ? 1 : 0;
    const long double r = psf.radius, aspect = psf.pixel_aspect;
    const long double x0 = x - (long double)psf.centre.x, x1 = x0 + 1;
    const long double y0 = (y - (long double)psf.centre.y) / aspect, y1 = y0 + 1 / aspect;
    const long double area = signed_quadrant_area(r, x1, y1) - signed_quadrant_area(r, x0, y1) -
                             signed_quadrant_area(r, x1, y0) + signed_quadrant_area(r, x0, y0);
    return double(std::max(0.0L, area) / (std::numbers::pi_v<long double> * r * r));
}

// The part of a row on one side of the centre's row, distances from the centre (in units of a pixel's width):
// between `low` and `high` <= radius, where half the chord is `outer` and `inner`.
struct PsfRows::Band {
    double low = 0, high = 0, outer = 0, inner = 0;
};

PsfRows::PsfRows(const Psf &psf, const Imath::Box2i &box)
    : psf_(psf), box_(box), area_to_weight_(1 / (std::numbers::pi * psf.radius * psf.radius)) {
    assert(box.max.x - box.min.x < max_width);
    const double half_height = is_point(psf) ? 0 : psf.radius * psf.pixel_aspect;
    const double top = box.min.y, bottom = box.max.y + 1.0;
    begin_row_ = whole(std::floor(psf.centre.y - half_height), top, bottom);
    end_row_ = whole(std::floor(psf.centre.y + half_height) + 1, top, bottom);
    if (is_point(psf)) {
        const int column = int(std::floor(psf.centre.x));
        if (column < box.min.x || column > box.max.x) end_row_ = begin_row_;
        return;
    }
    const int columns = box.max.x + 1 - box.min.x;
    for (int i = 0; i <= columns; ++i)
        height_[std::size_t(i)] = half_chord(psf.radius, std::abs(box.min.x + i - psf.centre.x));
}

PsfRows::Band PsfRows::band(double low, double high) const {
    low = std::min(low, psf_.radius);
    high = std::min(high, psf_.radius);
    return {low, high, half_chord(psf_.radius, low), half_chord(psf_.radius, high)};
}

// Area of disc and band between the centre's column and the edge, negative to the left of the centre.
// Out to `inner` the band is full; from there the arc falls from (inner, high) to where it meets the edge or
// leaves the band: a trapezoid under the chord and the segment above it.
double PsfRows::area_left_of(const Band &band, int edge) const {
    const double x = edge - psf_.centre.x, distance = std::abs(x);
    const double full = std::min(distance, band.inner) * (band.high - band.low);
    const double end_x = std::clamp(distance, band.inner, band.outer);
    const double end_y = std::clamp(height_[std::size_t(edge - box_.min.x)], band.low, band.high);
    const double run = end_x - band.inner, fall = band.high - end_y;
    const double under_chord = run * ((band.high + end_y) / 2 - band.low);
    return std::copysign(full + under_chord + segment_area(psf_.radius, run * run + fall * fall), x);
}

PsfRows::Span PsfRows::point_row(double *weights) const {
    const int column = int(std::floor(psf_.centre.x));
    weights[column - box_.min.x] = 1;
    return {column, column + 1};
}

PsfRows::Span PsfRows::row(int y, double *weights) const {
    if (is_point(psf_)) return point_row(weights);
    // The row's edges, in units of a pixel's width; the row that holds the centre is two bands.
    const double top = (y - psf_.centre.y) / psf_.pixel_aspect,
                 bottom = (y + 1 - psf_.centre.y) / psf_.pixel_aspect;
    std::array<Band, 2> bands{};
    int count = 0;
    if (top < 0) bands[std::size_t(count++)] = band(std::max(0.0, -bottom), -top);
    if (bottom > 0) bands[std::size_t(count++)] = band(std::max(0.0, top), bottom);
    double outer = bands[0].outer, inner = bands[0].inner, height = bands[0].high - bands[0].low;
    if (count == 2) {
        outer = std::max(outer, bands[1].outer);
        inner = std::min(inner, bands[1].inner);
        height += bands[1].high - bands[1].low;
    }
    const double left = box_.min.x, right = box_.max.x + 1.0;
    const int begin = whole(std::floor(psf_.centre.x - outer), left, right);
    const int end = whole(std::ceil(psf_.centre.x + outer), left, right);
    const int full_begin = whole(std::ceil(psf_.centre.x - inner), begin, end);
    const int full_end = std::max(full_begin, whole(std::floor(psf_.centre.x + inner), begin, end));
    const auto border = [&](int first, int last) {
        const auto area = [&](int edge) {
            const double one = area_left_of(bands[0], edge);
            return count == 2 ? one + area_left_of(bands[1], edge) : one;
        };
        if (first == last) return;
        double before = area(first);
        for (int x = first; x < last; ++x) {
            const double after = area(x + 1);
            weights[x - box_.min.x] = std::max(0.0, after - before) * area_to_weight_;
            before = after;
        }
    };
    border(begin, full_begin);
    std::fill(weights + (full_begin - box_.min.x), weights + (full_end - box_.min.x),
              height * area_to_weight_);
    border(full_end, end);
    return {begin, end};
}

} // namespace sparselens
