// Astigmatism: rays along and across a line through the axis come to focus at different distances (lens/focus_field.h).
#pragma once

#include "look.h"

namespace sparselens::looks {

struct Astigmatism {
    std::optional<double> astigmatism = {};

    static constexpr auto rows() {
        return std::array{LookRow<Astigmatism>{{"astigmatism", "A",
                                                "Separates the focus of rays along and across a line through "
                                                "the axis, from -1 to 1: at the corners 1/d "
                                                "is 1 + A and 1 - A times as large (default: 0)",
                                                &Astigmatism::astigmatism, from_minus_1_to_1},
                                               {"astigmatism", -1, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const { looks.astigmatism = astigmatism.value_or(0); }
};

} // namespace sparselens::looks
