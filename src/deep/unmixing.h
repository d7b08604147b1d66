// How much of each of two colours is in a third: c = a F + (1 - a) B.
#pragma once

#include <Imath/ImathVec.h>

#include <optional>

namespace sparselens {

struct Mix {
    double share;    // a, of F
    double residual; // distance of c from the line through F and B, as a share of their contrast |F - B|
};

// Solves by least squares, with a prior that c is not mixed. If `mostly_b`, a is at most half, else at least half. The
// rest of c without B is light: (1 - a) B exceeds c in no channel. Returns nothing where F and B are too similar, where
// c is farther from the line than largest_residual, where the share of one of them is negligible, or where a colour is
// NaN.
std::optional<Mix> unmix(const Imath::V3d &c, const Imath::V3d &f, const Imath::V3d &b, bool mostly_b,
                         double largest_residual);

} // namespace sparselens
