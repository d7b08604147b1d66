#include "lens/polygon_pixels.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

double cross(const Imath::V2d &a, const Imath::V2d &b) { return a.x * b.y - a.y * b.x; }

// The integrals of one box while edges are added.
class Sums {
public:
    Sums(const RadialDensity &density, const Imath::Box2i &box, std::vector<double> &values)
        : density_(density), box_(box), width_(std::size_t(box.max.x - box.min.x) + 1), values_(values),
          rises_((width_ + 1) * (std::size_t(box.max.y - box.min.y) + 1)), moments_(rises_.size()) {
        values_.assign(width_ * (rises_.size() / (width_ + 1)), 0);
    }

    void add_edge(Imath::V2d from, Imath::V2d to) {
        const double sign = from.y < to.y ? 1 : -1;
        if (sign < 0) std::swap(from, to);
        const double top = std::max(from.y, double(box_.min.y)), bottom = std::min(to.y, box_.max.y + 1.0);
        const double slope = (to.x - from.x) / (to.y - from.y);
        const auto x_at = [&](double y) { return from.x + (y - from.y) * slope; };
        for (double y = top; y < bottom;) {
            const double row = std::floor(y), end = std::min(row + 1, bottom);
            add_in_row(int(row), {x_at(y), y}, {x_at(end), end}, sign);
            y = end;
        }
    }

    void finish() {
        for (std::size_t y = 0; y < values_.size() / width_; ++y) {
            double rise = 0, moment = 0;
            for (std::size_t x = 0; x < width_; ++x) {
                rise += rises_[y * (width_ + 1) + x];
                moment += moments_[y * (width_ + 1) + x];
                values_[y * width_ + x] +=
                    rise * across(box_.min.x + double(x), box_.min.x + double(x) + 1) + moment;
            }
        }
    }

private:
    // The integral along x of the term that does not depend on y, and of the term that does, for each x.
    double across(double from, double to) const {
        const double a = from - density_.centre.x, b = to - density_.centre.x;
        return density_.constant * (b - a) +
               density_.quadratic * density_.scale.x * density_.scale.x * (b * b * b - a * a * a) / 3;
    }
    double down(double y) const {
        const double d = (y - density_.centre.y) * density_.scale.y;
        return density_.quadratic * d * d;
    }

    // Cuts a piece within a row at the edges between columns. The piece goes downwards from a to b.
    void add_in_row(int row, const Imath::V2d &a, const Imath::V2d &b, double sign) {
        const double left = box_.min.x, right = box_.max.x + 1.0;
        const double direction = a.x <= b.x ? 1 : -1;
        const auto y_at = [&](double x) {
            return std::clamp(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y), a.y, b.y);
        };
        Imath::V2d at = a;
        while (true) {
            // The column that holds the piece: -1 left of the box; beyond its right end nothing is added.
            const double edge = direction > 0 ? std::floor(at.x) : std::ceil(at.x) - 1;
            const double column = std::clamp(edge, left - 1, right);
            const double limit = direction > 0 ? (column >= right ? INFINITY : column + 1)
                                               : (column < left ? -INFINITY : column);
            const bool last = direction > 0 ? b.x <= limit : b.x >= limit;
            const Imath::V2d end = last ? b : Imath::V2d(limit, std::max(at.y, y_at(limit)));
            if (column < right) add_piece(row, int(column), at, end, sign);
            if (last) return;
            at = end;
        }
    }

    // Adds a piece within a pixel, or left of the box. The integrands are cubic in y, so two Gauss points are exact.
    void add_piece(int row, int column, const Imath::V2d &a, const Imath::V2d &b, double sign) {
        const double height = sign * (b.y - a.y) / 2;
        constexpr double gauss = 0.57735026918962576451; // 1 / sqrt(3)
        const std::size_t y = std::size_t(row - box_.min.y);
        double own = 0, rise = 0, moment = 0;
        for (const double t : {(1 - gauss) / 2, (1 + gauss) / 2}) {
            const Imath::V2d p = a + (b - a) * t;
            const double below = down(p.y);
            own += height * (across(p.x, column + 1.0) + (column + 1.0 - p.x) * below);
            rise += height;
            moment += height * below;
        }
        const std::size_t next = std::size_t(column + 1 - box_.min.x);
        if (column >= box_.min.x) values_[y * width_ + next - 1] += own;
        rises_[y * (width_ + 1) + next] += rise;
        moments_[y * (width_ + 1) + next] += moment;
    }

    const RadialDensity &density_;
    const Imath::Box2i &box_;
    std::size_t width_;
    std::vector<double> &values_;
    std::vector<double> rises_, moments_; // [row][column, and one beyond]: of the area left of the column
};

} // namespace

void integrate_over_pixels(std::span<const Imath::V2d> polygon, const RadialDensity &density,
                           const Imath::Box2i &box, std::vector<double> &values) {
    Sums sums(density, box, values);
    for (std::size_t i = 0; i < polygon.size(); ++i)
        sums.add_edge(polygon[i], polygon[(i + 1) % polygon.size()]);
    sums.finish();
    // The right side of an edge is outside if the edge rises with y up; here y runs down.
    if (signed_area(polygon) > 0)
        for (double &value : values) value = -value;
    for (double &value : values) value = std::max(value, 0.0);
}

double signed_area(std::span<const Imath::V2d> polygon) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        sum += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
    return sum / 2;
}

double mean_square_radius(std::span<const Imath::V2d> polygon) {
    double sum = 0, area = 0; // of triangles with the origin
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Imath::V2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double twice = cross(a, b);
        area += twice / 2;
        sum += twice / 12 * (a.dot(a) + a.dot(b) + b.dot(b));
    }
    return sum / area;
}

} // namespace sparselens
