// A measured curve of quality over cost, which is interpolated between its points and never extrapolated.
//
// The cost (seconds, or rays per pixel) is above 0; the quality is in dB of PSNR. Between neighbouring points the
// quality is linear in the logarithm of the cost, as for plain Monte Carlo: twice the samples halve the mean square
// error, 3 dB.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace sparselens::lab {

struct CurvePoint {
    double cost, quality;
    bool operator==(const CurvePoint &) const = default;
};

// Sorted by cost; all costs are different.
using Curve = std::vector<CurvePoint>;

// Keeps the best of several points at one cost, and drops points that are not finite or have no cost.
Curve curve_of(std::span<const CurvePoint> points);

// The quality at that cost; nothing if it is outside the measured costs.
std::optional<double> quality_at(const Curve &curve, double cost);

// The cost at which a curve first reaches a quality. The ends of the curve are bounds, not estimates.
struct Reached {
    enum Bound {
        exactly, // at `cost`, interpolated
        at_most, // the first point already has that quality
        beyond,  // no point has that quality: `cost` is the largest measured
        unknown  // the curve has no points
    } bound = unknown;
    double cost = 0;
};

Reached reached_at(const Curve &curve, double quality);

} // namespace sparselens::lab
