// The simple tone mapping under which pictures are compared: v / (1 + v), then gamma 1/2.2.
#pragma once

#include <algorithm>
#include <cmath>

namespace sparselens {

// Scene-linear [0, inf) to [0, 1). What is negative (ringing filters, out-of-gamut colour) counts as black,
// as a display shows it.
inline double tone_mapped(double v) {
    const double positive = std::max(v, 0.0);
    return std::pow(positive / (1 + positive), 1 / 2.2);
}

} // namespace sparselens
