// The area of an aperture, relative to that of the f-number's circle. The sides of its blades are straight.
#pragma once

#include "lens/aperture_shape.h"

#include <cmath>
#include <numbers>

namespace sparselens {

// The shape must not be that of a picture.
inline double area_of(const ApertureShape &shape) {
    if (shape.blades == 0) return 1 / shape.squeeze;
    const double side = 2 * std::numbers::pi / shape.blades; // as seen from the middle
    return std::sin(side) / side / shape.squeeze;
}

} // namespace sparselens
