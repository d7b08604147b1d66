#include "lens/aperture.h"

#include "base/error.h"
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

namespace {

struct Crop {
    int left, top, right, bottom; // `right` and `bottom` lie beyond it
};

Crop content_of(const AperturePicture &picture) {
    Crop crop{picture.width, picture.height, 0, 0};
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const float *rgb =
                &picture.rgb[(std::size_t(y) * std::size_t(picture.width) + std::size_t(x)) * 3];
            if (rgb[0] <= 0 && rgb[1] <= 0 && rgb[2] <= 0) continue;
            crop.left = std::min(crop.left, x);
            crop.top = std::min(crop.top, y);
            crop.right = std::max(crop.right, x + 1);
            crop.bottom = std::max(crop.bottom, y + 1);
        }
    if (crop.left >= crop.right) throw Error("the picture of the aperture is black: no light would pass");
    return crop;
}

} // namespace

PictureTable::PictureTable(const AperturePicture &picture,
                           const std::function<double(const Imath::V2d &, std::size_t colour)> &weigh) {
    const Crop crop = content_of(picture);
    width_ = crop.right - crop.left;
    height_ = crop.bottom - crop.top;
    half_extent_ = Imath::V2d(width_, height_) / std::max(width_, height_);
    sums_.resize(std::size_t(width_ + 1) * std::size_t(height_ + 1));
    for (int row = 0; row < height_; ++row) {
        LightOfColours in_row{};
        for (int column = 0; column < width_; ++column) {
            const auto pixel = std::size_t(crop.bottom - 1 - row) * std::size_t(picture.width) +
                               std::size_t(crop.left + column);
            const float *rgb = &picture.rgb[pixel * 3];
            const Imath::V2d at((2 * (column + 0.5) / width_ - 1) * half_extent_.x,
                                (2 * (row + 0.5) / height_ - 1) * half_extent_.y);
            const std::array<double, 3> weight{weigh(at, 0), weigh(at, 1), weigh(at, 2)};
            const std::size_t above = index(std::size_t(column) + 1, std::size_t(row) + 1),
                              below = index(std::size_t(column) + 1, std::size_t(row));
            for (std::size_t k = 0; k < 3; ++k) in_row[k] += weight[k] * std::max(0.0, double(rgb[k]));
            for (std::size_t k = 0; k < 3; ++k) sums_[above][k] = sums_[below][k] + in_row[k];
            coloured_ = coloured_ || rgb[0] != rgb[1] || rgb[1] != rgb[2] || weight[0] != weight[1] ||
                        weight[1] != weight[2];
        }
    }
    const LightOfColours all = sums_.back();
    for (std::size_t k = 0; k < 3; ++k)
        if (!(all[k] > 0 && std::isfinite(all[k])))
            throw Error(std::string("the picture of the aperture has no ") + "RGB"[k] +
                        " light: give it some in each channel, or make it grey");
    for (LightOfColours &sum : sums_) {
        for (std::size_t k = 0; k < 3; ++k) sum[k] /= all[k];
        sum[3] = (sum[0] + sum[1] + sum[2]) / 3;
    }
}

// Light is even within a square of the picture, so that the sums are bilinear there.
LightOfColours PictureTable::before(double x, double y) const {
    x = std::clamp(x, 0.0, double(width_));
    y = std::clamp(y, 0.0, double(height_));
    const auto column = std::size_t(std::min(int(x), width_ - 1)),
               row = std::size_t(std::min(int(y), height_ - 1));
    const double fx = x - double(column), fy = y - double(row);
    LightOfColours sum;
    for (std::size_t k = 0; k < 4; ++k)
        sum[k] =
            (1 - fy) * ((1 - fx) * sums_[index(column, row)][k] + fx * sums_[index(column + 1, row)][k]) +
            fy * ((1 - fx) * sums_[index(column, row + 1)][k] + fx * sums_[index(column + 1, row + 1)][k]);
    return sum;
}

LightOfColours PictureTable::share(const Imath::Box2d &box) const {
    const auto column = [&](double x) { return (x / half_extent_.x + 1) / 2 * width_; };
    const auto row = [&](double y) { return (y / half_extent_.y + 1) / 2 * height_; };
    const double left = column(box.min.x), right = column(box.max.x), low = row(box.min.y),
                 high = row(box.max.y);
    const LightOfColours a = before(left, low), b = before(right, low), c = before(left, high),
                         d = before(right, high);
    LightOfColours sum;
    for (std::size_t k = 0; k < 4; ++k) sum[k] = std::max(0.0, d[k] - c[k] - b[k] + a[k]);
    return sum;
}

Imath::V2d PictureTable::place(double s, double t) const {
    const std::size_t w = std::size_t(width_), h = std::size_t(height_);
    // Finds the first of 1..n whose sum is above the share, and how far into it the share reaches.
    const auto find = [](std::size_t n, double share, const auto &sum_at) {
        std::size_t low = 1, high = n;
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            sum_at(middle) > share ? high = middle : low = middle + 1;
        }
        const double from = sum_at(low - 1), to = sum_at(low);
        return double(low - 1) + (to > from ? std::clamp((share - from) / (to - from), 0.0, 1 - 1e-9) : 0.5);
    };
    const double y = find(h, s, [&](std::size_t i) { return mean_before(w, i); });
    const auto row = std::min(std::size_t(y), h - 1);
    const auto in_row = [&](std::size_t i) { return mean_before(i, row + 1) - mean_before(i, row); };
    const double x = find(w, t * in_row(w), in_row);
    return {(2 * x / width_ - 1) * half_extent_.x, (2 * y / height_ - 1) * half_extent_.y};
}

std::array<double, 3> PictureTable::colour(const Imath::V2d &place) const {
    const auto square = [](double v, double half, int n) {
        return std::size_t(std::clamp(int((v / half + 1) / 2 * n), 0, n - 1));
    };
    const std::size_t x = square(place.x, half_extent_.x, width_),
                      y = square(place.y, half_extent_.y, height_);
    LightOfColours light;
    for (std::size_t k = 0; k < 4; ++k)
        light[k] = sums_[index(x + 1, y + 1)][k] - sums_[index(x, y + 1)][k] - sums_[index(x + 1, y)][k] +
                   sums_[index(x, y)][k];
    if (light[3] <= 0) return {0, 0, 0};
    return {light[0] / light[3], light[1] / light[3], light[2] / light[3]};
}

} // namespace sparselens
