// The cat's eye of a lens that is longer than its aperture is wide (lens/cat_eye.h).
#pragma once

#include "look.h"

namespace sparselens::looks {

struct CatEye {
    std::optional<double> cat_eye = {};
    std::optional<bool> cat_eye_darkening = {};

    static constexpr auto rows() {
        constexpr NumberRange to_100{"a number from 0 to 100", [](double v) { return v >= 0 && v <= 100; }};
        return std::array{LookRow<CatEye>{{"cat-eye", "A",
                                           "Cat's eye: a second circle cuts the aperture, displaced by A "
                                           "radii at the picture's corner (default: 0)",
                                           &CatEye::cat_eye, to_100},
                                          {"cat's eye", 0, 3}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        looks.cat_eye = cat_eye.value_or(0);
        looks.cat_eye_darkening = cat_eye_darkening.value_or(false);
    }
};

} // namespace sparselens::looks
