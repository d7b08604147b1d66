#include "lens/cat_eye.h"

#include "lens/outline.h"
#include "lens/polygons/polygon_pixels.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr double tolerance = 1e-4; // of outlines, radii
constexpr int step = 8;            // pixels between places where the share is computed
constexpr int points_a_side = 64;

} // namespace

CatEye::CatEye(const Aperture &aperture, const LensLooks &looks, const PictureFrame &frame)
    : aperture_(aperture), amount_(looks.cat_eye), darkens_(looks.cat_eye_darkening), frame_(frame) {
    if (!cuts() || !aperture.shape().picture) return;
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
    // The middles of pixels that see it lie between these.
    const double left = frame_.axis.x + (x - half) / per_pixel - 0.5 - first,
                 right = frame_.axis.x + (x + half) / per_pixel - 0.5 - first;
    const auto bound = [&](double v) { return int(std::clamp(v, 0.0, double(count))); };
    return {bound(std::ceil(left)), bound(std::floor(right) + 1)};
}

double CatEye::share(bool behind, const Imath::V2d &p) const {
    const Imath::V2d middle = centre(p);
    const auto side = [&](const LensPoint &point) { return double(behind ? point.behind : point.in_front); };
    if (!points_.empty()) {
        double all = 0, left = 0;
        for (const LensPoint &point : points_) {
            all += side(point);
            left += passes(point.u, p) ? side(point) : 0;
        }
        return left / all;
    }
    const std::vector<Imath::V2d> whole = aperture_outline(aperture_.shape(), tolerance);
    const std::vector<Imath::V2d> left = within_unit_circle(whole, middle, tolerance);
    const double area = left.empty() ? 0 : signed_area(left);
    if (area <= 0) return 0;
    // The weight is linear in r^2.
    return std::min(1.0, area / signed_area(whole) * aperture_.weight(behind, mean_square_radius(left)));
}

std::vector<double> CatEye::shares(bool behind, const Imath::Box2i &box) const {
    const int width = box.max.x - box.min.x + 1, height = box.max.y - box.min.y + 1;
    const int columns = (width + step - 1) / step + 1, rows = (height + step - 1) / step + 1;
    std::vector<double> nodes;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            nodes.push_back(
                share(behind, Imath::V2d(box.min + Imath::V2i(column, row) * step) + Imath::V2d(0.5)));
    std::vector<double> all;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double *node = &nodes[std::size_t(y / step * columns + x / step)];
            const double fx = double(x % step) / step, fy = double(y % step) / step;
            all.push_back(std::lerp(std::lerp(node[0], node[1], fx),
                                    std::lerp(node[columns], node[columns + 1], fx), fy));
        }
    return all;
}

} // namespace sparselens
