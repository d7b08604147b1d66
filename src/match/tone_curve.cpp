#include "match/tone_curve.h"

#include "base/median.h"
#include "match/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace sparselens {

namespace {

// A point of the curve: of some pixels of about one value, their mean and the median of the plate.
struct Point {
    double pixels = 0, from = 0, to = 0;
};

// How many pixels have each value of the plate, for some pixels of about one value of the shown picture.
using Counts = std::array<int, 4 * MatchTuning::curve_points>;

std::size_t place_of(float value, std::size_t places) {
    return std::min(std::size_t(std::clamp(value, 0.0f, 1.0f) * float(places)), places - 1);
}

double median_of(const Counts &counts, double pixels) {
    double before = 0;
    std::size_t at = 0;
    while (2 * (before + counts[at]) < pixels) before += counts[at++];
    return (double(at) + (pixels / 2 - before) / counts[at]) / double(counts.size());
}

std::vector<Point> points_of(const std::vector<float> &plate, std::span<const std::uint8_t> usable,
                             const std::vector<float> &shown) {
    std::vector<Point> points(MatchTuning::curve_points);
    std::vector<Counts> counts(points.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
        if (!usable[i] || !std::isfinite(plate[i]) || !std::isfinite(shown[i])) continue;
        const std::size_t at = place_of(shown[i], points.size());
        ++points[at].pixels;
        points[at].from += double(shown[i]);
        ++counts[at][place_of(plate[i], counts[at].size())];
    }
    for (std::size_t at = 0; at < points.size(); ++at) {
        if (points[at].pixels == 0) continue;
        points[at].from /= points[at].pixels;
        points[at].to = median_of(counts[at], points[at].pixels);
    }
    std::erase_if(points, [](const Point &point) { return point.pixels == 0; });
    return points;
}

template <typename Visit>
void for_each_pixel(const Grid &grid, const Imath::Box2i &box, const Visit &visit) {
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x) visit(grid.index(x, y));
}

// Joins neighbouring points until the curve rises everywhere.
std::vector<Point> rising(const std::vector<Point> &points) {
    std::vector<Point> curve;
    for (Point next : points) {
        while (!curve.empty() && curve.back().to >= next.to) {
            const Point &last = curve.back();
            const double pixels = last.pixels + next.pixels;
            next = {pixels, (last.pixels * last.from + next.pixels * next.from) / pixels,
                    (last.pixels * last.to + next.pixels * next.to) / pixels};
            curve.pop_back();
        }
        curve.push_back(next);
    }
    return curve;
}

// Linear between the points, constant beyond them.
double value_at(const std::vector<Point> &curve, double from) {
    const auto after = std::ranges::upper_bound(curve, from, {}, &Point::from);
    if (after == curve.begin()) return after->to;
    const Point &before = *(after - 1);
    if (after == curve.end()) return before.to;
    return before.to + (after->to - before.to) * (from - before.from) / (after->from - before.from);
}

Colours with_curves(const Colours &plate, std::span<const std::uint8_t> usable, Colours shown) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<Point> curve = rising(points_of(plate.rgb[k], usable, shown.rgb[k]));
        if (curve.empty()) continue;
        for (float &v : shown.rgb[k]) v = float(value_at(curve, double(v)));
    }
    return shown;
}

// The usable pixels of the blocks that are about as near to the plate as most are.
std::vector<std::uint8_t> alike(const Colours &plate, std::span<const std::uint8_t> usable,
                                const Colours &shown) {
    const Tiles tiles(plate.grid.box(), MatchTuning::compared_block_px);
    std::vector<double> errors(tiles.count());
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        double pixels = 0;
        for_each_pixel(plate.grid, tiles.box(t), [&](std::size_t i) {
            if (!usable[i]) return;
            ++pixels;
            for (std::size_t k = 0; k < 3; ++k)
                errors[t] += std::abs(double(plate.rgb[k][i] - shown.rgb[k][i]));
        });
        errors[t] = pixels > 0 ? errors[t] / pixels : std::numeric_limits<double>::infinity();
    }
    std::vector<double> sorted = errors;
    const double most = MatchTuning::alike * median(sorted);
    std::vector<std::uint8_t> result(usable.begin(), usable.end());
    for (std::size_t t = 0; t < tiles.count(); ++t)
        if (!(errors[t] <= most))
            for_each_pixel(plate.grid, tiles.box(t), [&](std::size_t i) { result[i] = 0; });
    return result;
}

} // namespace

Colours with_curve_of(const Colours &plate, std::span<const std::uint8_t> usable, const Colours &shown) {
    return with_curves(plate, alike(plate, usable, with_curves(plate, usable, shown)), shown);
}

} // namespace sparselens
