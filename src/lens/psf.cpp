#include "lens/psf.h"

#include "kernels/psf_rules.h"
#include "lens/aperture.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sparselens {

using namespace kernels;

double psf_share(const Psf &psf, const Imath::Box2d &box) {
    if (psf.radius < smallest_psf_radius) return box.intersects(psf.centre) ? 1 : 0;
    const Imath::V2d low = box.min - psf.centre, high = box.max - psf.centre;
    return area_between(psf.radius, low.x, low.y / psf.pixel_aspect, high.x, high.y / psf.pixel_aspect) /
           (pi * psf.radius * psf.radius);
}

double psf_weight(const Psf &psf, int x, int y) {
    if (psf.radius < smallest_psf_radius)
        return std::floor(psf.centre.x) == x && std::floor(psf.centre.y) == y ? 1 : 0;
    const long double left = x - (long double)psf.centre.x, aspect = psf.pixel_aspect;
    const long double top = (y - (long double)psf.centre.y) / aspect;
    const auto radius = (long double)psf.radius;
    return double(area_between(radius, left, top, left + 1, top + 1 / aspect) /
                  (std::numbers::pi_v<long double> * radius * radius));
}

PsfRows::PsfRows(const Psf &psf, const Imath::Box2i &box)
    : psf_(psf), box_(box), point_(psf.radius < smallest_psf_radius),
      area_to_weight_(1 / (pi * psf.radius * psf.radius)) {
    assert(box.max.x - box.min.x < max_size && box.max.y - box.min.y < max_size);
    const double radius = point_ ? 0 : psf.radius, high = radius * psf.pixel_aspect;
    const int bottom = box.max.y + 1;
    rows_ = {first_within(psf.centre.y, high, box.min.y, bottom),
             end_within(psf.centre.y, high, box.min.y, bottom)};
    columns_ = columns_within(radius);
    if (columns_.begin >= columns_.end) rows_.end = rows_.begin;
    if (point_ || rows_.begin >= rows_.end) return;
    for (int x = columns_.begin; x <= columns_.end; ++x)
        height_[std::size_t(x - box.min.x)] = half_chord(radius, std::abs(x - psf.centre.x));
    for (int y = rows_.begin; y <= rows_.end; ++y)
        width_[std::size_t(y - box.min.y)] =
            half_chord(radius, std::abs(y - psf.centre.y) / psf.pixel_aspect);
}

// The columns of the box that lie within a distance of the centre, in part or whole.
PsfRows::Span PsfRows::columns_within(double distance) const {
    const int right = box_.max.x + 1;
    return {first_within(psf_.centre.x, distance, box_.min.x, right),
            end_within(psf_.centre.x, distance, box_.min.x, right)};
}

// The area that the arc cuts off the columns from `column` outwards (Direction 1: to the right).
template <int Direction>
void PsfRows::add_arc(const kernels::Band &band, int column, double *weights) const {
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
        weights[column - box_.min.x] +=
            area_to_weight_ * area_under(x, y, end_x, end_y, band.low, psf_.radius);
        x = end_x;
        y = end_y;
    }
}

void PsfRows::add_band(const kernels::Band &band, double *weights) const {
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
    // Edges of the row, in pixel widths. The row that holds the centre is split into two bands.
    const double top = (y - psf_.centre.y) / psf_.pixel_aspect,
                 bottom = (y + 1 - psf_.centre.y) / psf_.pixel_aspect;
    const double at_top = width_[std::size_t(y - box_.min.y)],
                 at_bottom = width_[std::size_t(y - box_.min.y) + 1];
    const bool above = top<0, below = bottom> 0;
    const Span columns = columns_within(above && below ? psf_.radius : above ? at_bottom : at_top);
    std::fill(weights + (columns.begin - box_.min.x), weights + (columns.end - box_.min.x), 0.0);
    for (const bool is_above : {true, false})
        if (is_above ? above : below)
            add_band(band_of(is_above, top, bottom, at_top, at_bottom, psf_.radius), weights);
    return columns;
}

LightReach::LightReach(const ThinLens &lens, const LensLooks &looks, const Windows &windows)
    : frame_(picture_frame(windows, looks)), field_(looks, lens, frame_),
      magnification_(looks.magnification) {
    const Imath::V2d half = Aperture(looks.aperture).half_extent();
    extent_ = {half.x, half.y * lens.pixel_aspect};
    for (const double coc : looks.chromatic_coc) {
        least_chromatic_ = std::min(least_chromatic_, coc);
        most_chromatic_ = std::max(most_chromatic_, coc);
    }
}

Imath::V2d LightReach::at(const Imath::V2d &p, double coc) const {
    double bent = coc, steepest = 1;
    if (!field_.flat()) {
        const Imath::V2d gradient = field_.coc_gradient(p);
        bent += field_.coc_offset(p);
        steepest = stretch(gradient, gradient.normalized() * std::max(extent_.x, extent_.y));
    }
    const double largest = std::max(std::abs(bent + least_chromatic_), std::abs(bent + most_chromatic_));
    const double beside = field_.skew(p).length() / magnification_ * std::max(extent_.x, extent_.y);
    return (extent_ * largest + Imath::V2d(beside)) * steepest;
}

Imath::Box2d LightReach::box(const Imath::V2d &p, double coc) const {
    const Imath::V2d middle = frame_.magnified(p, magnification_), reach = at(p, coc) * magnification_;
    return {middle - reach, middle + reach};
}

} // namespace sparselens
