// How much of each of two colours is in a third: c = a F + (1 - a) B.
#pragma once

#include <Imath/ImathVec.h>

#include <optional>

namespace sparselens {

struct Mix {
    double share;    // a, of F
    double residual; // distance of c from the line through F and B, as a share of their contrast |F - B|
};

// By least squares with a prior that c is not mixed. mostly_b: a is at most half, else at least half. What is left
// of c without B is light: (1 - a) B is nowhere more than c. Nothing where F and B are too like to tell, where c is
// farther from the line than largest_residual, where so little of one is in it that it is not worth telling, or a
// colour is no number.
std::optional<Mix> unmix(const Imath::V3d &c, const Imath::V3d &f, const Imath::V3d &b, bool mostly_b,
                         double largest_residual);

} // namespace sparselens
