// The simple tone mapping with which pictures are compared: v / (1 + v), then gamma 1/2.2.
#pragma once

#include <algorithm>
#include <cmath>

namespace sparselens {

// Maps scene-linear [0, inf) to [0, 1). Negative values (ringing filters, out-of-gamut colours) count as black, as a
// display shows them.
inline double tone_mapped(double v) {
    const double positive = std::max(v, 0.0);
    return std::pow(positive / (1 + positive), 1 / 2.2);
}

} // namespace sparselens
