#include "match/tone_curve.h"

#include "base/numbers.h"
#include "base/parallel.h"
#include "match/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

// A point of the curve: of some pixels of about one value, their mean and what the plate has there.
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

// The medians of the plate.
std::vector<Point> median_points(const std::vector<float> &plate, std::span<const std::uint8_t> usable,
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

// The means of the plate. A value counts for the two points beside it, so the curve changes steadily with the picture.
// Otherwise the likelihood would be ragged, and a search would end anywhere.
std::vector<Point> mean_points(const std::vector<float> &plate, std::span<const float> weights,
                               const std::vector<float> &shown) {
    std::vector<Point> points(MatchTuning::curve_points);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        if (!(weights[i] > 0) || !std::isfinite(plate[i]) || !std::isfinite(shown[i])) continue;
        const double at = std::clamp(double(shown[i]), 0.0, 1.0) * double(points.size() - 1);
        const std::size_t before = std::min(std::size_t(at), points.size() - 2);
        for (const std::size_t k : {before, before + 1}) {
            const double weight = double(weights[i]) * (1 - std::abs(at - double(k)));
            points[k].pixels += weight;
            points[k].from += weight * double(shown[i]);
            points[k].to += weight * double(plate[i]);
        }
    }
    std::erase_if(points, [](const Point &point) { return !(point.pixels > 0); });
    for (Point &point : points) {
        point.from /= point.pixels;
        point.to /= point.pixels;
    }
    return points;
}

template <typename Visit>
void for_each_pixel(const Grid &grid, const Imath::Box2i &box, const Visit &visit) {
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x) visit(grid.index(Imath::V2i(x, y)));
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

// The curve through points: linear between them, constant beyond them.
class Curve {
public:
    explicit Curve(std::vector<Point> points) : points_(std::move(points)) { // at least one
        for (std::size_t bin = 0; bin < after_.size(); ++bin) {
            const double begin = double(bin) / MatchTuning::curve_points;
            after_[bin] =
                std::size_t(std::ranges::upper_bound(points_, begin, {}, &Point::from) - points_.begin());
        }
    }
    double at(double from) const {
        std::size_t after = std::isnan(from) ? points_.size() : after_[place_of(float(from), after_.size())];
        while (after < points_.size() && points_[after].from <= from) ++after;
        if (after == 0) return points_.front().to;
        const Point &before = points_[after - 1];
        if (after == points_.size()) return before.to;
        const Point &next = points_[after];
        return before.to + (next.to - before.to) * (from - before.from) / (next.from - before.from);
    }

private:
    std::vector<Point> points_;
    std::array<std::size_t, MatchTuning::curve_points>
        after_{}; // [bin of values]: the first point beyond its begin
};

// `points(k)`: of channel k.
template <typename Points>
Rgb with_curves(Rgb shown, const Points &points) {
    parallel_for(3, [&](std::size_t k) {
        std::vector<Point> some = rising(points(k));
        if (some.empty()) return;
        const Curve curve(std::move(some));
        parallel_ranges(shown.rgb[k].size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                shown.rgb[k][i] = float(curve.at(double(shown.rgb[k][i])));
        });
    });
    return shown;
}

// The weight of each pixel: small in blocks that are farther from the plate than most blocks, 0 if it is not usable.
std::vector<float> likeness(const Rgb &plate, std::span<const std::uint8_t> usable, const Rgb &shown) {
    const Tiles tiles(plate.grid.box(), MatchTuning::compared_block_px);
    std::vector<double> errors(tiles.count()), known; // `known`: of blocks with usable pixels
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        double pixels = 0;
        for_each_pixel(plate.grid, tiles.box(t), [&](std::size_t i) {
            if (!usable[i]) return;
            ++pixels;
            for (std::size_t k = 0; k < 3; ++k)
                errors[t] += std::abs(double(plate.rgb[k][i] - shown.rgb[k][i]));
        });
        if (pixels > 0) known.push_back(errors[t] /= pixels);
    }
    const double alike = known.empty() ? 0 : MatchTuning::alike * median(known);
    std::vector<float> weights(usable.size());
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        const double weight = errors[t] > 0 ? 1 / (1 + std::pow(errors[t] / alike, 4)) : 1;
        for_each_pixel(plate.grid, tiles.box(t),
                       [&](std::size_t i) { weights[i] = usable[i] ? float(weight) : 0; });
    }
    return weights;
}

} // namespace

Rgb with_curve_of(const Rgb &plate, std::span<const std::uint8_t> usable, const Rgb &shown) {
    const Rgb about =
        with_curves(shown, [&](std::size_t k) { return median_points(plate.rgb[k], usable, shown.rgb[k]); });
    const std::vector<float> weights = likeness(plate, usable, about);
    return with_curves(shown,
                       [&](std::size_t k) { return mean_points(plate.rgb[k], weights, shown.rgb[k]); });
}

namespace {

// The value from which pixels count as clipped; infinite: none is.
float clipped_from(std::span<const float> plane) {
    std::vector<float> values;
    std::ranges::copy_if(plane, std::back_inserter(values), [](float v) { return std::isfinite(v); });
    constexpr float none = std::numeric_limits<float>::infinity();
    if (values.empty()) return none;
    const double largest = double(*std::ranges::max_element(values));
    const auto above = [&](double share) {
        return double(std::ranges::count_if(values, [&](float v) { return double(v) >= share * largest; }));
    };
    const bool is_clipped = largest > 0 && above(MatchTuning::brightest) >=
                                               MatchTuning::clipped_share * above(MatchTuning::bright);
    return is_clipped ? float(MatchTuning::bright * largest) : none;
}

} // namespace

void raise_clipped(std::span<float> plane) {
    const float from = clipped_from(plane);
    for (float &value : plane)
        if (value >= from) value *= MatchTuning::clipped_factor;
}

} // namespace sparselens
