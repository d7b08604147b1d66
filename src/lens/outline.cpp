#include "lens/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace sparselens {

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
