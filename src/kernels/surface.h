// Thresholds that decide whether two samples near each other show one surface, in pixels of disparity.
#pragma once

#include <cmath>

namespace sparselens {

// One surface: seen from the rim of the lens, such samples move apart by less than half a pixel and stay in the same
// pixel.
inline constexpr float one_surface_px = 0.5f;

// Steep: a facet with a smaller difference from corner to corner leaves no gap to close.
inline constexpr float steep_px = 0.25f;

// Torn: nothing spreads between neighbouring samples that differ by more.
inline constexpr float torn_px = 1;

// One mirror or glass: samples of it a few pixels apart differ by less than this.
inline constexpr float one_mirror_px = 1;

namespace kernels {

// Equal depths are one, whatever the tolerance.
template <typename Real>
inline bool is_one_surface(Real a, Real b, Real within) {
    return std::abs(a - b) < within || a == b;
}

} // namespace kernels

} // namespace sparselens
