// Maps between places in the centre view and in another view. The axes of the cameras are parallel.
//
// Let F be the focal length of the centre view, c and c' the principal points of the centre view and of the view, s the
// zoom of the view and (X, Y, Z) the position of its camera. A point that the view shows at q, at depth z, appears in
// the centre view at
//
//     p = c + (q - c') / s + (F (X, -Y) - Z (q - c') / s) / z
//
// by similar triangles (Y is multiplied by the pixel aspect). Z, like all depths here, is measured from the camera of
// the centre view. Where both views frame the scene alike (c = c', s = 1, Z = 0), this is exactly p = q + (F / z) (X,
// -Y). Positions are in pixels, y down.
#pragma once

#include "base/image.h"
#include "kernels/warp_rules.h"
#include "view/framing.h"

namespace sparselens {

// A principal point, given in display widths from the middle of the display window (see Camera), in pixels.
Imath::V2d in_pixels(const Imath::V2d &principal_point, const Windows &windows);

class ViewMapping {
public:
    // `position`: of the view's camera, scene units, x right, y up. `focal_px`: F.
    ViewMapping(const Imath::V2d &position, double focal_px, const Windows &windows, const Framing &view = {},
                const Imath::V2d &centre_principal_point = {0, 0});

    // p = at_infinity(q) + parallax(q) / z.
    Imath::V2d at_infinity(const Imath::V2d &q) const {
        return {kernels::at_infinity(q.x, unzoom_, offset_.x), kernels::at_infinity(q.y, unzoom_, offset_.y)};
    }
    Imath::V2d parallax(const Imath::V2d &q) const {
        return {kernels::parallax(q.x, step_.x, approach_), kernels::parallax(q.y, step_.y, approach_)};
    }

    // Where the view shows a point that the centre view shows at p; NaN if the point lies behind the view's camera.
    Imath::V2d in_view(const Imath::V2d &p, double inverse_z) const;

    double unzoom() const { return unzoom_; }
    double approach() const { return approach_; }

private:
    double unzoom_;     // 1 / s
    double approach_;   // Z / s
    Imath::V2d offset_; // c - c' / s
    Imath::V2d step_;   // F (X, -Y) + Z c' / s: pixels times scene units
};

} // namespace sparselens
