#include "lab/report/curve.h"

#include <algorithm>
#include <cmath>

namespace sparselens::lab {

namespace {

// The cost at `share`, [0, 1], of the way from a to b in log(cost).
double cost_between(const CurvePoint &a, const CurvePoint &b, double share) {
    return a.cost * std::pow(b.cost / a.cost, share);
}

} // namespace

Curve curve_of(std::span<const CurvePoint> points) {
    Curve curve;
    for (const CurvePoint &point : points)
        if (std::isfinite(point.cost) && point.cost > 0 && std::isfinite(point.quality))
            curve.push_back(point);
    std::ranges::sort(curve, [](const CurvePoint &a, const CurvePoint &b) {
        return a.cost != b.cost ? a.cost < b.cost : a.quality > b.quality;
    });
    const auto same_cost = [](const CurvePoint &a, const CurvePoint &b) { return a.cost == b.cost; };
    curve.erase(std::unique(curve.begin(), curve.end(), same_cost), curve.end());
    return curve;
}

std::optional<double> quality_at(const Curve &curve, double cost) {
    const auto after = std::ranges::lower_bound(curve, cost, {}, &CurvePoint::cost);
    if (after == curve.end()) return {};
    if (after->cost == cost) return after->quality;
    if (after == curve.begin()) return {};
    const CurvePoint &before = *(after - 1);
    const double share = std::log(cost / before.cost) / std::log(after->cost / before.cost);
    return before.quality + share * (after->quality - before.quality);
}

Reached reached_at(const Curve &curve, double quality) {
    if (curve.empty()) return {};
    const auto good = std::ranges::find_if(curve, [&](const CurvePoint &p) { return p.quality >= quality; });
    if (good == curve.end()) return {Reached::beyond, curve.back().cost};
    if (good->quality == quality) return {Reached::exactly, good->cost};
    if (good == curve.begin()) return {Reached::at_most, good->cost};
    const CurvePoint &before = *(good - 1);
    const double share = (quality - before.quality) / (good->quality - before.quality);
    return {Reached::exactly, cost_between(before, *good, share)};
}

} // namespace sparselens::lab
