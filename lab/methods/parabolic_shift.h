// One pixel of a line under the piecewise parabolic method: see accumulate.h.
#pragma once

namespace sparselens {

// Written out, because in this form compilers vectorise loops over these functions.
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }

// The value nearest to `value` between the bounds, which may come in either order.
inline float between(float value, float bound, float other_bound) {
    return larger(smaller(value, larger(bound, other_bound)), smaller(bound, other_bound));
}

// The integral over [0, t], t in [0, 1], of the parabola inside the pixel of value c, in a line a b c d e. Over the
// whole pixel it is c.
inline float integral_inside(float a, float b, float c, float d, float e, float t) {
    // At pixel borders, the fourth-order interpolation, limited to the range of the two pixels' values.
    const float left = between((7 * (b + c) - (a + d)) / 12, b, c);
    const float right = between((7 * (c + d) - (b + e)) / 12, c, d);
    // The parabola must be monotone over both edges: the edge values must be on either side of c, neither more than
    // twice as far away as the other. At a local extreme the parabola becomes a constant.
    const float to_left = left - c, to_right = right - c;
    const float l = between(to_left, 0, -2 * to_right), r = between(to_right, 0, -2 * to_left);
    const float slope = r - l, curve = -3 * (l + r);
    return t * (c + l + t * ((slope + curve) / 2 - t * curve / 3));
}

} // namespace sparselens
