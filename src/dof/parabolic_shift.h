// One pixel of a line under the piecewise parabolic method: see accumulate.h.
#pragma once

#include <algorithm>
#include <cmath>

namespace sparselens {

// The value between pixels of values b and c, a before and d after them: of fourth order, never outside [b,
// c].
inline float value_between(float a, float b, float c, float d) {
    const float value = (7 * (b + c) - (a + d)) / 12;
    return std::clamp(value, std::min(b, c), std::max(b, c));
}

// The integral over [0, t], t in [0, 1], of the parabola inside the pixel of value c, in a line a b c d e.
// Over the whole pixel it is c.
inline float integral_inside(float a, float b, float c, float d, float e, float t) {
    float left = value_between(a, b, c, d), right = value_between(b, c, d, e);
    // A local extreme is flat; a parabola that would overshoot is made to have its vertex at one edge.
    const bool monotone = (left < c && c < right) || (left > c && c > right);
    const float step = std::abs(right - left);
    const float bend = (6 * c - 3 * (left + right)) * (right < left ? -1.0f : 1.0f);
    const float steepest_left = 3 * c - 2 * right, steepest_right = 3 * c - 2 * left;
    left = !monotone ? c : bend > step ? steepest_left : left;
    right = !monotone ? c : bend < -step ? steepest_right : right;
    const float slope = right - left, curve = 6 * c - 3 * (left + right);
    return t * (left + t * ((slope + curve) / 2 - t * curve / 3));
}

} // namespace sparselens
