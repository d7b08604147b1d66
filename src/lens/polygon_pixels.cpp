#include "lens/polygon_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

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
    // If signed_area() is above 0, the left edges run towards smaller y, which add_edge() counts as negative.
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

namespace {

using std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Arc {
    Imath::V2d centre;
    double radius, begin, end; // angles, begin <= end
};

// Adds the points of an arc except its end. They lie slightly outside the arc, so that the chords enclose its area.
void add_arc(std::vector<Imath::V2d> &points, const Arc &arc, double tolerance) {
    const double step = std::min(std::sqrt(8 * tolerance / arc.radius), pi / 8);
    const int n = std::max(1, int(std::ceil((arc.end - arc.begin) / step)));
    const double angle = (arc.end - arc.begin) / n;
    const double radius = angle > 0 ? arc.radius * std::sqrt(angle / std::sin(angle)) : arc.radius;
    for (int i = 0; i < n; ++i) {
        const double at = arc.begin + i * angle;
        points.push_back(arc.centre + radius * Imath::V2d(std::cos(at), std::sin(at)));
    }
}

// The part [first, second] of the way from a to b that lies within 1 of `centre`.
std::optional<std::pair<double, double>> inside_part(const Imath::V2d &a, const Imath::V2d &b,
                                                     const Imath::V2d &centre) {
    const Imath::V2d way = b - a, from = a - centre;
    const double aa = way.dot(way), half_b = way.dot(from), c = from.dot(from) - 1;
    const double root = half_b * half_b - aa * c;
    if (aa == 0 || root <= 0) return {};
    const double first = std::max(0.0, (-half_b - std::sqrt(root)) / aa),
                 second = std::min(1.0, (-half_b + std::sqrt(root)) / aa);
    if (first >= second) return {};
    return std::pair(first, second);
}

bool is_inside(std::span<const Imath::V2d> polygon, const Imath::V2d &p) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Imath::V2d a = polygon[i], side = polygon[(i + 1) % polygon.size()] - a;
        if (side.x * (p.y - a.y) - side.y * (p.x - a.x) < 0) return false;
    }
    return !polygon.empty();
}

} // namespace

std::vector<Imath::V2d> aperture_outline(const ApertureShape &shape, double tolerance) {
    std::vector<Imath::V2d> points;
    if (shape.blades == 0 || shape.curvature == 1) {
        add_arc(points, {{0, 0}, 1, 0, 2 * pi}, tolerance);
        return points;
    }
    const double half_side = pi / shape.blades, turn = 2 * half_side;
    // Turning by a whole side changes nothing; reduced like this, not even rounding differs.
    const double rotation = std::fmod(shape.rotation * pi / 180, turn);
    const double height = shape.curvature * (1 - std::cos(half_side)), half_chord = std::sin(half_side);
    for (int k = 0; k < shape.blades; ++k) {
        const double middle = rotation + k * turn;
        if (height == 0) {
            points.emplace_back(std::cos(middle - half_side), std::sin(middle - half_side));
            continue;
        }
        const double radius = (half_chord * half_chord + height * height) / (2 * height);
        const double opening = std::asin(std::min(1.0, half_chord / radius));
        const double distance = std::cos(half_side) + height - radius;
        add_arc(points,
                {distance * Imath::V2d(std::cos(middle), std::sin(middle)), radius, middle - opening,
                 middle + opening},
                tolerance);
    }
    return points;
}

std::vector<Imath::V2d> within_unit_circle(std::span<const Imath::V2d> polygon, const Imath::V2d &centre,
                                           double tolerance) {
    const auto angle_at = [&](const Imath::V2d &p) { return std::atan2(p.y - centre.y, p.x - centre.x); };
    std::vector<Imath::V2d> kept;
    double left_at = nan,
           first_entry = nan; // angles at which the outline last left the circle, and first entered it
    const auto add_circle = [&](double from, double to) {
        constexpr double rounding = 1e-9;
        if (to < from - rounding) to += 2 * pi;
        if (to > from) add_arc(kept, {centre, 1, from, to}, tolerance);
    };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Imath::V2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const auto part = inside_part(a, b, centre);
        if (!part) continue;
        const Imath::V2d entry = a + (b - a) * part->first, exit = a + (b - a) * part->second;
        if (part->first > 0) {
            if (!std::isnan(left_at))
                add_circle(left_at, angle_at(entry));
            else if (std::isnan(first_entry))
                first_entry = angle_at(entry);
        }
        left_at = nan;
        kept.push_back(entry);
        if (part->second < 1) {
            kept.push_back(exit);
            left_at = angle_at(exit);
        }
    }
    if (!std::isnan(left_at) && !std::isnan(first_entry)) add_circle(left_at, first_entry);
    if (kept.empty() && is_inside(polygon, centre)) add_circle(0, 2 * pi);
    return kept;
}

} // namespace sparselens
