// Spherical aberration, of all colours alike (lens/aperture_shape.h).
#pragma once

#include "look.h"

namespace sparselens::looks {

struct Spherical {
    std::optional<double> spherical = {};

    static constexpr auto rows() {
        return std::array{LookRow<Spherical>{{"spherical", "S",
                                              "Spherical aberration from -1 to 1: above 0, discs behind "
                                              "focus have bright rims and those in front "
                                              "bright cores (default: 0)",
                                              &Spherical::spherical, from_minus_1_to_1},
                                             {"soap bubbles", -1, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        for (double &of_colour : looks.aperture.spherical.of) of_colour += spherical.value_or(0);
    }
};

} // namespace sparselens::looks
