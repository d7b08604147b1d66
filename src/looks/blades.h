// The blades of the aperture: their number, how far they bulge, and their rotation (lens/aperture_shape.h).
#pragma once

#include "look.h"

namespace sparselens::looks {

inline constexpr NumberRange blade_count{"0 or a whole number from 3 to 16", [](double v) {
                                             return v == 0 || (v >= 3 && v <= 16 && std::trunc(v) == v);
                                         }};
inline constexpr NumberRange angle{"a number of degrees", [](double v) { return std::abs(v) <= 1e6; }};

struct Blades {
    std::optional<double> blades = {}, curvature = {}, rotation = {};

    static constexpr auto rows() {
        using Row = LookRow<Blades>;
        return std::array{
            Row{{"blades", "N",
                 "Number of blades, which is the number of corners of the aperture; 0: round (default: 0)",
                 &Blades::blades, blade_count},
                {"blades", 0, 16, 0, 3}},
            Row{{"blade-curvature", "C",
                 "Curvature of the blades, from 0, straight, to 1, round (default: 0)", &Blades::curvature,
                 from_0_to_1},
                {"blade roundness", 0, 1}},
            Row{{"blade-rotation", "DEG",
                 "Rotation of the blades, in degrees counter-clockwise for a lamp behind focus; 0: the "
                 "middle "
                 "of a side is at the right (default: 0)",
                 &Blades::rotation, angle},
                {"blade rotation, \u00b0", -180, 180}},
        };
    }
    void act(const LookContext &, LensLooks &looks) const {
        ApertureShape &shape = looks.aperture;
        shape.blades = int(blades.value_or(0));
        shape.curvature = curvature.value_or(shape.curvature);
        shape.rotation = rotation.value_or(shape.rotation);
    }
};

} // namespace sparselens::looks
