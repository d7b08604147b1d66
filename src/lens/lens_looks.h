// The looks of a real lens, besides f-number and focus.
#pragma once

#include "aperture_shape.h"

#include <Imath/ImathVec.h>

#include <array>

namespace sparselens {

struct LensLooks {
    ApertureShape aperture = {};
    // A second circle of the aperture's radius (squeezed with it) cuts the aperture. It is displaced by cat_eye times
    // the pixel's place relative to the optical axis, in half diagonals of the display window.
    double cat_eye = 0; // at least 0
    bool cat_eye_darkening =
        false; // colours lose the light that is cut off; otherwise the rest counts as the whole
    // Added to the CoC of R, G and B, pixels. G has no offset: it defines where the picture is sharp.
    std::array<double, 3> chromatic_coc{0, 0, 0};
    // The plane of focus: 1/d becomes (1/d) (1 + field_curvature rho^2) (1 + tilt.x x/F + tilt.y y/F) at a pixel x to
    // the right of the axis and y above it, rho half diagonals from it, with F the focal length in pixels.
    double field_curvature = 0;
    Imath::V2d tilt{0, 0}; // tangents of its angles
    // Separates the sagittal and tangential foci. For rays that meet the lens on the line through the axis and the
    // pixel, 1/d becomes (1/d) (1 + astigmatism rho^2); for rays across that line, (1/d) (1 - astigmatism rho^2).
    double astigmatism = 0;
    double magnification = 1; // of the whole picture about the axis, by breathing
    Imath::V2d axis{0, 0};    // the optical axis, from the middle of the display window, pixels, y down

    bool operator==(const LensLooks &) const = default;
};

// Magnification of a thin lens that focuses by moving as a whole, relative to focus at infinity: d / (d - f), with the
// focal length f and the focus distance d > f in the same unit.
inline double unit_focusing_magnification(double focal_length, double focus) {
    return 1 / (1 - focal_length / focus);
}

// The CoC in pixels of a colour that comes to focus `mm` farther behind the sensor: its cone is mm / (2 N) wide there.
// The sign is that of things in front of focus.
inline double defocus_coc(double mm, double fstop, double pixels_per_mm) {
    return -mm / (2 * fstop) * pixels_per_mm;
}

} // namespace sparselens
