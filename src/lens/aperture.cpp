#include "lens/aperture.h"

#include "lens/outline.h"
#include "lens/polygon_pixels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

constexpr double outline_error = 1e-3; // pixels
constexpr double first_level = 4;      // pixels of CoC

// Running sums of the triangles between the middle and the sides, divided by the sum of all.
std::vector<double> fan_areas(std::span<const Imath::V2d> outline) {
    std::vector<double> sums;
    double sum = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Imath::V2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
        sums.push_back(sum += a.x * b.y - a.y * b.x);
    }
    for (double &value : sums) value /= sum;
    return sums;
}

} // namespace

Aperture::Aperture(const ApertureShape &shape) : shape_(shape) {
    if (shape.picture) {
        picture_.emplace(*shape.picture, [](const Imath::V2d &, std::size_t) { return 1.0; });
        if (!two_sided()) return;
        for (const bool behind : {true, false})
            (behind ? behind_ : in_front_)
                .emplace(*shape.picture, [&](const Imath::V2d &p, std::size_t colour) {
                    return signed_weight(behind, p.dot(p), colour);
                });
        const double n = 512;
        mean_behind_ = mean_in_front_ = {0, 0, 0};
        for (double i = 0.5; i < n; ++i)
            for (double j = 0.5; j < n; ++j) {
                const Imath::V2d p = picture_->place(i / n, j / n);
                for (std::size_t k = 0; k < 3; ++k) {
                    mean_behind_[k] += signed_weight(true, p.dot(p), k) / (n * n);
                    mean_in_front_[k] += signed_weight(false, p.dot(p), k) / (n * n);
                }
            }
        return;
    }
    if (disc()) return;
    double coc = first_level;
    for (auto &outline : outlines_) {
        outline = aperture_outline(shape, outline_error / coc);
        coc *= 4;
    }
    const double mean_square = round() ? 0.5 : mean_square_radius(outlines_.back());
    for (std::size_t k = 0; k < 3; ++k) {
        mean_behind_[k] = signed_weight(true, mean_square, k);
        mean_in_front_[k] = signed_weight(false, mean_square, k);
    }
    if (round()) return;
    fan_ = aperture_outline(shape, 1e-6);
    fan_areas_ = fan_areas(fan_);
}

Imath::V2d Aperture::half_extent() const {
    if (picture_) return {picture_->half_extent().x / shape_.squeeze, picture_->half_extent().y};
    return {1 / shape_.squeeze, 1};
}

double Aperture::signed_weight(bool behind, double square_radius, std::size_t colour) const {
    const double spherical = std::clamp(shape_.spherical[colour], -1.0, 1.0);
    return std::max(0.0, 1 + (behind ? 1 : -1) * spherical * (2 * square_radius - 1));
}

double Aperture::weight(bool behind, double square_radius, std::size_t colour) const {
    return signed_weight(behind, square_radius, colour) / (behind ? mean_behind_ : mean_in_front_)[colour];
}

ColourFactors Aperture::factors(bool behind, double square_radius) const {
    ColourFactors factors;
    for (std::size_t k = 0; k < 3; ++k) factors[k] = float(weight(behind, square_radius, k));
    return factors;
}

Imath::V2d Aperture::place(const Imath::V2d &square) const {
    if (picture_) return picture_->place(square.x, square.y);
    const double radius = std::sqrt(square.x);
    if (round()) {
        const double angle = 2 * std::numbers::pi * square.y;
        return {radius * std::cos(angle), radius * std::sin(angle)};
    }
    const auto at = std::upper_bound(fan_areas_.begin(), fan_areas_.end() - 1, square.y);
    const std::size_t i = std::size_t(at - fan_areas_.begin());
    const double before = i == 0 ? 0 : fan_areas_[i - 1];
    const Imath::V2d &a = fan_[i], &b = fan_[(i + 1) % fan_.size()];
    return radius * (a + (b - a) * ((square.y - before) / (*at - before)));
}

LensPoint Aperture::at(const Imath::V2d &square) const {
    const Imath::V2d p = place(square);
    LensPoint point{{p.x / shape_.squeeze, p.y}};
    if (picture_ && picture_->coloured()) {
        const std::array<double, 3> colour = picture_->colour(p);
        for (std::size_t k = 0; k < 3; ++k) point.rgb[k] = float(colour[k]);
    }
    if (two_sided()) {
        point.behind = factors(true, p.dot(p));
        point.in_front = factors(false, p.dot(p));
    }
    return point;
}

std::vector<Imath::V2d> Aperture::outline(double coc) const {
    if (disc()) return aperture_outline(shape_, outline_error / std::max(coc, first_level));
    std::size_t level = 0;
    for (double fine_to = first_level; fine_to < coc && level + 1 < levels; fine_to *= 4) ++level;
    return outlines_[level];
}

const PictureTable *Aperture::picture(bool behind) const {
    if (!picture_) return nullptr;
    if (!two_sided()) return &*picture_;
    return behind ? &*behind_ : &*in_front_;
}

} // namespace sparselens
