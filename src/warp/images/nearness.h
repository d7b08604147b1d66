// How much a pixel of a view counts in the mean of what falls into a pixel of the centre view.
#pragma once

#include <cmath>

namespace sparselens {

// (dx, dy): where it falls, pixels from the middle. A mean of pixels that lie apart is blurred, hence those near the
// middle count more.
inline double nearness(double dx, double dy) {
    constexpr double spread = 0.3; // pixels; less is sharper, more averages more noise away
    return std::exp(-0.5 * (dx * dx + dy * dy) / (spread * spread));
}

} // namespace sparselens
