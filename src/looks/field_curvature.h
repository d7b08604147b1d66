// A plane of focus that is bent (lens/focus_field.h).
#pragma once

#include "look.h"

namespace sparselens::looks {

struct FieldCurvature {
    std::optional<double> field_curvature = {};

    static constexpr auto rows() {
        return std::array{LookRow<FieldCurvature>{{"field-curvature", "K",
                                                   "Bends the plane of focus, from -1 to 1: 1/d is 1 + K "
                                                   "times as large at the picture's corners (default: "
                                                   "0)",
                                                   &FieldCurvature::field_curvature, from_minus_1_to_1},
                                                  {"curved focus", -1, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        looks.field_curvature = field_curvature.value_or(0);
    }
};

} // namespace sparselens::looks
