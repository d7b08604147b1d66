// The looks of a real lens, besides f-number and focus.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

namespace sparselens {

// The shape of the aperture as a user gives it: blades or a picture, squeezed or not, and the weights of its rings.
//
// The f-number's circle has the radius 1, x right and y up. Behind focus a lamp becomes an upright picture of the
// aperture, in front of it a picture turned by 180 degrees:
//
//     3 blades, rotation 30:   behind  /\    in front  ____
//                                     /__\             \  /
//                                                       \/
//
// As in Cycles, the middle of the first side lies at the angle `rotation`, counter-clockwise from +x as a lamp behind
// focus shows it. The side's corners lie on the circle, half a side before and after the middle.

// Weights of the light that passes, row by row from the top: [row][column][R, G, B], at least 0 and finite. They are
// squares in a grid whose middle lies on the optical axis and whose longer side is 2 long, from rim to rim.
struct AperturePicture {
    int width = 0, height = 0;
    std::vector<float> rgb;
};

// A number for each of R, G and B. One number stands for all three.
struct ByColour {
    std::array<double, 3> of{0, 0, 0};

    constexpr ByColour(double all = 0) : of{all, all, all} {}
    constexpr ByColour(double r, double g, double b) : of{r, g, b} {}
    double operator[](std::size_t colour) const { return of[colour]; }
    double &operator[](std::size_t colour) { return of[colour]; }
    bool even() const { return of[0] == of[1] && of[1] == of[2]; }
    bool operator==(const ByColour &) const = default;
};

struct ApertureShape {
    int blades = 0;       // 0: round; otherwise a regular polygon of 3..16 corners
    double curvature = 0; // of its sides, [0, 1]: their height over the chord, 1: the circle's height
    double rotation = 0;  // degrees
    double squeeze = 1;   // (0, inf): how many times higher than wide; the height is the circle's
    // Weight 1 + S (2 r^2 - 1) behind focus, 1 - S (2 r^2 - 1) in front; r is before squeezing, S limited to [-1, 1].
    ByColour spherical = 0;
    std::shared_ptr<const AperturePicture> picture = {}; // replaces the blades if set

    bool operator==(const ApertureShape &) const = default;
};

// The area of an aperture, relative to that of the f-number's circle. The sides of its blades are straight.

// The shape must not be that of a picture.
inline double area_of(const ApertureShape &shape) {
    if (shape.blades == 0) return 1 / shape.squeeze;
    const double side = 2 * std::numbers::pi / shape.blades; // as seen from the middle
    return std::sin(side) / side / shape.squeeze;
}

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

// The CoC in pixels of a colour that comes to focus `mm` behind the sensor: its cone has the radius mm / (2 N) on the
// sensor. For mm above 0, the sign is that of things in front of focus.
inline double defocus_coc(double mm, double fstop, double pixels_per_mm) {
    return -mm / (2 * fstop) * pixels_per_mm;
}

} // namespace sparselens
