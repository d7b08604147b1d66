// Where the centre view shows what another view shows, and the other way round; the cameras' axes are parallel.
//
// With F the centre view's focal length, c and c' the principal points of the centre view and of the view, s the
// view's zoom and (X, Y, Z) the place of its camera, what it shows at q at depth z lies in the centre view at
//
//     p = c + (q - c') / s + (F (X, -Y) - Z (q - c') / s) / z
//
// by similar triangles (with wide pixels, Y counts by their aspect). Z, as all depths here, is measured from the centre
// view's camera. Where both frame the scene alike (c = c', s = 1, Z = 0) it is p = q + (F / z) (X, -Y), to the bit.
// Places are in pixels, y down.
#pragma once

#include "base/image.h"
#include "view/framing.h"

namespace sparselens {

// Of a principal point, pixels: from the middle of the display window in display widths (see Camera).
Imath::V2d in_pixels(const Imath::V2d &principal_point, const Windows &windows);

class ViewMapping {
public:
    // `position` of the view's camera: scene units, x right, y up. focal_px: F.
    ViewMapping(const Imath::V2d &position, double focal_px, const Windows &windows, const Framing &view = {},
                const Imath::V2d &centre_principal_point = {0, 0});

    // p is at_infinity(q) + parallax(q) / z.
    Imath::V2d at_infinity(const Imath::V2d &q) const { return q * unzoom_ + offset_; }
    Imath::V2d parallax(const Imath::V2d &q) const { return step_ - q * approach_; }

    // Where the view shows what the centre view shows at p; NaN: nowhere, it lies behind the view's camera.
    Imath::V2d in_view(const Imath::V2d &p, double inverse_z) const;

private:
    double unzoom_;     // 1 / s
    double approach_;   // Z / s
    Imath::V2d offset_; // c - c' / s
    Imath::V2d step_;   // F (X, -Y) + Z c' / s: pixels times scene units
};

} // namespace sparselens
