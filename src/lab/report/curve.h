// A measured curve of quality over cost: what it says between its points, never beyond them.
//
// Cost (seconds, or rays a pixel) is above 0, quality is in dB of PSNR. Between neighbouring points quality is linear
// in the logarithm of cost, as it is for plain Monte Carlo: twice the samples, half the mean square error, 3 dB.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace sparselens::lab {

struct CurvePoint {
    double cost, quality;
    bool operator==(const CurvePoint &) const = default;
};

// Sorted by cost, costs all different.
using Curve = std::vector<CurvePoint>;

// Of points at one cost the best is kept; points that are not finite, or of no cost, say nothing.
Curve curve_of(std::span<const CurvePoint> points);

// Quality at that cost; nothing where it lies outside of the measured costs.
std::optional<double> quality_at(const Curve &curve, double cost);

// At which cost a curve first reaches a quality. The ends of the curve are bounds, not estimates.
struct Reached {
    enum Bound {
        exactly, // at `cost`, interpolated
        at_most, // the first point is that good already
        beyond,  // no point is: `cost` is the largest measured
        unknown  // the curve has no points
    } bound = unknown;
    double cost = 0;
};

Reached reached_at(const Curve &curve, double quality);

} // namespace sparselens::lab
