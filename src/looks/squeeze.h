// An aperture that is narrower than high, as an anamorphic lens has it (lens/aperture_shape.h).
#pragma once

#include "look.h"

namespace sparselens::looks {

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

} // namespace sparselens::looks
