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
#include "view/view.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <optional>

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

// How a camera's own motion moves the picture of things that stand still.
class CameraMotion {
public:
    // Where `to` shows what `from` shows at p (pixels, EXR coordinates) at planar depth z, in (0, inf]. NaN if that
    // lies behind the camera `to`.
    Imath::V2d moved(const Imath::V2d &p, double z) const;

private:
    friend std::optional<CameraMotion> camera_motion(const Camera &, const Camera &, const Windows &);
    struct Pinhole {
        double focal;    // pixels
        double aspect;   // of a pixel
        Imath::V2d axis; // where it meets the picture, pixels
    };
    static std::optional<Pinhole> pinhole_of(const Camera &camera, const Windows &windows);

    Pinhole from_, to_;
    Imath::M44d between_; // from one camera's space to the other's
};

// Both pictures have the same display window. Empty if a matrix or a focal length is unknown.
std::optional<CameraMotion> camera_motion(const Camera &from, const Camera &to, const Windows &windows);

} // namespace sparselens
