// Focus breathing: the picture grows as the lens focuses nearer (lens/lens_looks.h).
#pragma once

#include "look.h"

namespace sparselens::looks {

struct Breathing {
    std::optional<double> breathing = {};

    static constexpr auto rows() {
        constexpr NumberRange to_2{"a number from 0 to 2", [](double v) { return v >= 0 && v <= 2; }};
        return std::array{LookRow<Breathing>{{"breathing", "B",
                                              "Focus breathing: magnification by focusing, from 0 to 2; 1 is "
                                              "a thin lens that moves as a whole "
                                              "(default: 0)",
                                              &Breathing::breathing, to_2},
                                             {"focus breathing", 0, 2}}};
    }
    // Needs the focal length. Throws UsageError if the lens cannot focus that near.
    void act(const LookContext &context, LensLooks &looks) const;
};

} // namespace sparselens::looks
