// Looks that change the shape of discs.
#pragma once

#include "look.h"

namespace sparselens::looks {

// The blades of the aperture: their number, how far they bulge, and their rotation (lens/lens_looks.h).

inline constexpr NumberRange blade_count{"0 or a whole number from 3 to 16", [](double v) {
                                             return v == 0 || (v >= 3 && v <= 16 && std::trunc(v) == v);
                                         }};
inline constexpr NumberRange angle{"a number of degrees", [](double v) { return std::abs(v) <= 1e6; }};

struct Blades {
    std::optional<double> blades = {}, curvature = {}, rotation = {};

    static constexpr auto rows() {
        using Row = LookRow<Blades>;
        return std::array{
            Row{{"blades", "N", "Number of blades, from 3 to 16; 0: a round aperture (default: 0)",
                 &Blades::blades, blade_count},
                {"blades", 0, 16, 0, 3}},
            Row{{"blade-curvature", "C",
                 "Curvature of the blades, from 0 (straight) to 1 (round) (default: 0)", &Blades::curvature,
                 from_0_to_1},
                {"blade roundness", 0, 1}},
            Row{{"blade-rotation", "DEG",
                 "Rotation of the blades, in degrees, counter-clockwise for a lamp behind focus; 0: the "
                 "middle of a side is at the right (default: 0)",
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

// An aperture that is narrower than high, as an anamorphic lens has it (lens/lens_looks.h).

struct Squeeze {
    std::optional<double> squeeze = {};

    static constexpr auto rows() {
        constexpr NumberRange stretch{"a number from 0.001 to 1000",
                                      [](double v) { return v >= 1e-3 && v <= 1e3; }};
        return std::array{LookRow<Squeeze>{
            {"squeeze", "S",
             "Height of the aperture divided by its width, e.g. 2 for an anamorphic lens (default: 1)",
             &Squeeze::squeeze, stretch},
            {"anamorphic squeeze", 0.001, 4, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        looks.aperture.squeeze = squeeze.value_or(looks.aperture.squeeze);
    }
};

// The cat's eye of a lens that is longer than its aperture is wide (lens/cat_eye.h).
struct CatEye {
    std::optional<double> cat_eye = {};
    std::optional<bool> cat_eye_darkening = {};

    static constexpr auto rows() {
        constexpr NumberRange to_100{"a number from 0 to 100", [](double v) { return v >= 0 && v <= 100; }};
        return std::array{LookRow<CatEye>{{"cat-eye", "A",
                                           "Cat's eye: a second circle cuts the aperture, displaced by A "
                                           "radii at the picture's corners, from 0 to 100 (default: 0)",
                                           &CatEye::cat_eye, to_100},
                                          {"cat's eye", 0, 3}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        looks.cat_eye = cat_eye.value_or(0);
        looks.cat_eye_darkening = cat_eye_darkening.value_or(false);
    }
};

// Spherical aberration, of all colours alike (lens/lens_looks.h).

struct Spherical {
    std::optional<double> spherical = {};

    static constexpr auto rows() {
        return std::array{
            LookRow<Spherical>{{"spherical", "S",
                                "Spherical aberration, from -1 to 1: above 0, discs behind focus have bright "
                                "rims, those in front bright cores (default: 0)",
                                &Spherical::spherical, from_minus_1_to_1},
                               {"soap bubbles", -1, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        for (double &of_colour : looks.aperture.spherical.of) of_colour += spherical.value_or(0);
    }
};

// Spherochromatism: spherical aberration that differs by colour. An achromatic lens corrects it for green: red stays
// undercorrected and blue becomes overcorrected (R. Kingslake, R. B. Johnson, "Lens Design Fundamentals", 2010, chapter
// 5). Soap-bubble lenses show it as rims of another colour than the disc.
//
// The coefficient S of the weights (lens/lens_looks.h) is that of the spherical aberration for green, S - K for red
// and S + K for blue, K in [-1, 1]. Each is limited to [-1, 1], and the mean of each colour's weights stays 1. With K
// above 0, a disc behind focus has a blue rim and a reddish core, and a disc in front a red rim and a bluish core.
struct Spherochromatism {
    std::optional<double> spherochromatism = {};

    static constexpr auto rows() {
        return std::array{LookRow<Spherochromatism>{
            {"spherochromatism", "K",
             "Spherical aberration that is K less for red and K more for blue, from -1 to 1: above 0, discs "
             "behind focus have blue rims, those in front red rims (default: 0)",
             &Spherochromatism::spherochromatism, from_minus_1_to_1},
            {"coloured rims", -1, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        looks.aperture.spherical[0] -= spherochromatism.value_or(0);
        looks.aperture.spherical[2] += spherochromatism.value_or(0);
    }
};

} // namespace sparselens::looks
