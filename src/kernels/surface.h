// Whether two samples near each other show one surface: how far their perceptive depths, in pixels, may differ.
#pragma once

#include <cmath>

namespace sparselens {

// Seen from the rim of the lens, samples that differ by less move apart by less than half a pixel, so that pictures of both
// fall into the same pixels.
inline constexpr float one_surface_px = 0.5f;

// Less from corner to corner of a facet leaves no gap that has to be closed.
inline constexpr float steep_px = 0.25f;

// Samples side by side that differ by more are torn apart: nothing spreads from one to the other.
inline constexpr float torn_px = 1;

// On a mirror or glass, samples a few pixels apart.
inline constexpr float one_mirror_px = 1;

namespace kernels {

// Equal depths are one, whatever the tolerance.
template <typename Real>
inline bool is_one_surface(Real a, Real b, Real within) {
    return std::abs(a - b) < within || a == b;
}

} // namespace kernels

} // namespace sparselens
