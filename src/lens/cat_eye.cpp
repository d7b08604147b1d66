#include "lens/cat_eye.h"

#include "lens/polygon_pixels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

constexpr double tolerance = 1e-4;      // of outlines, radii
constexpr int angles = 128, radii = 96; // of tables
constexpr int points_a_side = 64;

} // namespace

CatEye::CatEye(const Aperture &aperture, const LensLooks &looks, const PictureFrame &frame)
    : aperture_(aperture), amount_(looks.cat_eye), darkens_(looks.cat_eye_darkening), frame_(frame) {
    if (!cuts()) return;
    if (!aperture.shape().picture) {
        outline_ = aperture_outline(aperture.shape(), tolerance);
        reach_ = 2;
        return;
    }
    reach_ = 1 + std::sqrt(2.0);
    for (int i = 0; i < points_a_side; ++i)
        for (int j = 0; j < points_a_side; ++j)
            points_.push_back(aperture.at(Imath::V2d(i + 0.5, j + 0.5) / points_a_side));
}

CatEye::Columns CatEye::columns(const LensSample &point, int first, int count, int y) const {
    const double x = double(point.x) * aperture_.shape().squeeze, up = -double(point.y) / frame_.pixel_aspect;
    const double per_pixel = shift_per_pixel();
    const double off = up - centre({0, y + 0.5}).y;
    if (off * off > 1) return {};
    const double half = std::sqrt(1 - off * off);
    // The middles of the pixels that see the point lie between these.
    const double left = frame_.axis.x + (x - half) / per_pixel - 0.5 - first,
                 right = frame_.axis.x + (x + half) / per_pixel - 0.5 - first;
    const auto bound = [&](double v) { return int(std::clamp(v, 0.0, double(count))); };
    return {bound(std::ceil(left)), bound(std::floor(right) + 1)};
}

double CatEye::share(Light light, const Imath::V2d &p, std::size_t colour) const {
    return share_of(light, colour, centre(p));
}

double CatEye::share_of(Light light, std::size_t colour, const Imath::V2d &middle) const {
    if (!points_.empty()) {
        double all = 0, left = 0;
        for (const LensPoint &point : points_) {
            const double weight = light == Light::evenly ? 1 : point.side(light == Light::behind, colour);
            all += weight;
            left += within(point.u, middle) ? weight : 0;
        }
        return left / all;
    }
    const std::vector<Imath::V2d> left = within_unit_circle(outline_, middle, tolerance);
    const double area = left.empty() ? 0 : signed_area(left);
    if (area <= 0) return 0;
    // The weight is linear in r^2.
    const double weight = light == Light::evenly
                              ? 1
                              : aperture_.weight(light == Light::behind, mean_square_radius(left), colour);
    return std::min(1.0, area / signed_area(outline_) * weight);
}

// Interpolates linearly in radius and in angle, because a cat-eye has a kink on the axis.
double CatEye::share_from(const std::vector<double> &table, const Imath::V2d &middle) const {
    const double r = middle.length() / reach_ * (radii - 1);
    if (!(r < radii - 1)) return 0;
    const double turn = std::atan2(middle.y, middle.x) / (2 * std::numbers::pi),
                 angle = (turn < 0 ? turn + 1 : turn) * angles;
    const auto row = [&](int a) {
        const double *of = &table[std::size_t(a % angles * radii) + std::size_t(r)];
        return std::lerp(of[0], of[1], r - std::floor(r));
    };
    return std::lerp(row(int(angle)), row(int(angle) + 1), angle - std::floor(angle));
}

std::vector<double> CatEye::shares(Light light, const Imath::Box2i &box, std::size_t colour) const {
    const std::size_t of = colour * 3 + std::size_t(light);
    std::vector<double> &table = tables_[of];
    std::call_once(made_[of], [&] {
        for (int a = 0; a < angles; ++a)
            for (int r = 0; r < radii; ++r) {
                const double angle = 2 * std::numbers::pi * a / angles, radius = reach_ * r / (radii - 1);
                table.push_back(
                    share_of(light, colour, radius * Imath::V2d(std::cos(angle), std::sin(angle))));
            }
    });
    std::vector<double> all;
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x)
            all.push_back(share_from(table, centre({x + 0.5, y + 0.5})));
    return all;
}

} // namespace sparselens
