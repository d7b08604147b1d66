// One rule for what no view saw: a surface goes on where no view contradicts it, as far as a lens point may look.
//
// - Confirmed: views looked there, but something nearer hid the place. The warp adds samples and solids to the LDI
//   (extend_surfaces.h).
// - Assumed: no view could look there. Fillers (fillers.h) show where nothing else does, and hide lamps.
// - Beyond the frame: frame_extension.h.
//
// A surface goes on along rows and columns, from its last pixel, if something nearer hides it in the next pixel. A
// surface that ends where nothing is nearer has an outer edge, and does not go on. Surfaces may go on into one pixel
// from several sides. If they have the same depth there, they become one sample, which is their mean. In the n-th pixel
// after its end, a surface has the weight 1 / n.
#pragma once

#include "kernels/surface.h"

#include <Imath/ImathVec.h>

#include <array>
#include <numbers>

namespace sparselens {

// The steps to the right, to the left, down and up.
inline const std::array<Imath::V2i, 4> sides_of_pixel{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

// How many pixels, along a row or a column, a lens point looks behind the edge of what is nearer by this many pixels of
// disparity. The edge may run at 45 degrees.
template <typename Real>
inline Real seen_behind(Real nearer) {
    return 1 + std::numbers::sqrt2_v<Real> * nearer;
}
// Whether some lens point sees the n-th pixel behind the edge.
template <typename Real>
inline bool is_seen_behind(int n, Real nearer) {
    return Real(n - 1) < std::numbers::sqrt2_v<Real> * nearer;
}

// The disparity of a surface n pixels after its end, from those at its end and n pixels before it: slopes go on.
inline double mirrored(double at_end, double before) { return 2 * at_end - before; }

// Whether two disparities belong to one surface.
template <typename Real>
inline bool is_one_surface(Real a, Real b) {
    return kernels::is_one_surface<Real>(a, b, one_surface_px);
}

} // namespace sparselens
