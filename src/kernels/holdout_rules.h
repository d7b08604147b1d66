// How much of the light from depth z passes a sample of a holdout (deep/holdout.h).
#pragma once

#include "kernels/types.h"

namespace sparselens::kernels {

// Whether a sample that begins at `front` hides light from depth z. Depths that differ by rounding alone are equal, and
// do not hide each other.
template <typename Real>
inline bool is_held_out(Real front, Real z) {
    return front < z * (1 - 1 / Real(1000000));
}

// A volume hides by the share of it that lies in front of z. `clear`: the share of light that passes all of it.
template <typename Real>
inline Real passes_part(Real front, Real back, Real clear, Real z) {
    return back > z && clear > 0 ? pow(clear, (z - front) / (back - front)) : clear;
}

} // namespace sparselens::kernels
