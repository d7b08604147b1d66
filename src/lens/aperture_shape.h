// What a user says of the shape of the aperture: blades or a picture, squeezed or not, and how its rings weigh.
//
// The f-number's circle has the radius 1, x right and y up. Behind focus a lamp becomes a picture of the aperture as it
// is; in front of it, one turned by 180 degrees:
//
//     3 blades, rotation 90:   behind  /\    in front  ____
//                                     /__\             \  /
//                                                       \/
//
// As in Cycles, the middle of the first side lies at the angle `rotation`, counter-clockwise from +x as a lamp behind
// focus shows it, its corners half a side before and after it on the circle. (Three blades at 90 degrees have a side on
// top; the drawing is turned by 60.)
#pragma once

#include <memory>
#include <vector>

namespace sparselens {

// Weights of the light that passes, row by row from the top: [row][column][R, G, B], at least 0 and finite. Squares in a
// grid, its middle on the optical axis, its longer side 2 long: from rim to rim.
struct AperturePicture {
    int width = 0, height = 0;
    std::vector<float> rgb;
};

struct ApertureShape {
    int blades = 0;       // 0: round; else a regular polygon of 3..16 corners
    double curvature = 0; // of its sides, [0, 1]: their height over the chord, 1 that of the circle
    double rotation = 0;  // degrees
    double squeeze = 1;   // (0, inf): how many times higher than wide; the height is the circle's
    double spherical =
        0; // [-1, 1]: weight 1 + spherical (2 r^2 - 1) behind focus, minus it in front; r before squeezing
    std::shared_ptr<const AperturePicture> picture = {}; // in place of the blades, if there is one

    bool operator==(const ApertureShape &) const = default;
};

} // namespace sparselens
