// What of the light from depth z a sample lets through that holds it out (deep/holdout.h).
#pragma once

#include "kernels/types.h"

namespace sparselens::kernels {

// Samples that begin there or in front of it: depths that differ by rounding alone are equal, and do not hide each other.
template <typename Real>
inline bool is_held_out(Real front, Real z) {
    return front < z * (1 - 1 / Real(1000000));
}

// A volume hides by the share of it that lies in front. `clear`: what passes all of it.
template <typename Real>
inline Real passes_part(Real front, Real back, Real clear, Real z) {
    return back > z && clear > 0 ? pow(clear, (z - front) / (back - front)) : clear;
}

} // namespace sparselens::kernels
