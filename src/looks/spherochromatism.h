// Spherochromatism: spherical aberration that differs by colour. An achromatic lens corrects it for green: red stays
// undercorrected and blue becomes overcorrected (R. Kingslake, R. B. Johnson, "Lens Design Fundamentals", 2010, chapter
// 5). Soap-bubble lenses show it as rims of another colour than the disc.
//
// The coefficient S of the weights (lens/aperture_shape.h) is that of the spherical aberration for green, S - K for red
// and S + K for blue, K in [-1, 1]. Each is limited to [-1, 1], and the mean of each colour's weights stays 1. With K
// above 0, a disc behind focus has a blue rim and a reddish core, and a disc in front of it a red rim and a bluish core.
#pragma once

#include "look.h"

namespace sparselens::looks {

struct Spherochromatism {
    std::optional<double> spherochromatism = {};

    static constexpr auto rows() {
        return std::array{LookRow<Spherochromatism>{
            {"spherochromatism", "K",
             "Spherical aberration that is K less for red and K more for blue than for green, from -1 to 1: "
             "above 0, discs behind focus have blue rims and those in front red rims (default: 0)",
             &Spherochromatism::spherochromatism, from_minus_1_to_1},
            {"coloured rims", -1, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        looks.aperture.spherical[0] -= spherochromatism.value_or(0);
        looks.aperture.spherical[2] += spherochromatism.value_or(0);
    }
};

} // namespace sparselens::looks
