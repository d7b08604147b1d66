// The circle of confusion (lens/thin_lens.h).
#pragma once

namespace sparselens::kernels {

// Returns the signed CoC, pixels. `scale`: R F. An infinite focus and an infinite depth are passed as flags, because a
// quotient of infinities is not a number.
inline double coc_of(double scale, double focus, bool focus_at_infinity, double z, bool z_at_infinity) {
    if (focus_at_infinity) return -scale / z;
    if (z_at_infinity) return scale / focus;
    // (z - d) / z, not 1/d - 1/z: the difference of two nearby depths is exact, the difference of their inverses is
    // not.
    return (scale / focus) * ((z - focus) / z);
}

} // namespace sparselens::kernels
