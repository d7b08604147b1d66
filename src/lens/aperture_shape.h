// The shape of the aperture as a user gives it: blades or a picture, squeezed or not, and the weights of its rings.
//
// The f-number's circle has the radius 1, x right and y up. Behind focus a lamp becomes an upright picture of the
// aperture, in front of it a picture turned by 180 degrees:
//
//     3 blades, rotation 90:   behind  /\    in front  ____
//                                     /__\             \  /
//                                                       \/
//
// As in Cycles, the middle of the first side lies at the angle `rotation`, counter-clockwise from +x as a lamp behind
// focus shows it. The side's corners lie on the circle, half a side before and after the middle. (Three blades at 90
// degrees have a side on top; the drawing is turned by 60.)
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace sparselens {

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
    double curvature = 0; // of its sides, [0, 1]: their height over the chord; 1 gives the circle
    double rotation = 0;  // degrees
    double squeeze = 1;   // (0, inf): how many times higher than wide; the height is the circle's
    // Weight 1 + S (2 r^2 - 1) behind focus and 1 - S (2 r^2 - 1) in front, r before squeezing, with S limited to [-1, 1].
    ByColour spherical = 0;
    std::shared_ptr<const AperturePicture> picture = {}; // replaces the blades if set

    bool operator==(const ApertureShape &) const = default;
};

} // namespace sparselens
