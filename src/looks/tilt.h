// A plane of focus that is tilted, by two angles (lens/focus_field.h). They are one pair on a command line, so that they
// have no row here.
#pragma once

#include "look.h"

#include <numbers>

namespace sparselens::looks {

struct Tilt {
    std::optional<double> tilt_x = {}, tilt_y = {}; // degrees, within -89 and 89

    static constexpr auto rows() { return std::array<LookRow<Tilt>, 0>{}; }
    void act(const LookContext &, LensLooks &looks) const {
        const auto tangent = [](const std::optional<double> &degrees) {
            return std::tan(degrees.value_or(0) * std::numbers::pi / 180);
        };
        looks.tilt = {tangent(tilt_x), tangent(tilt_y)};
    }
};

} // namespace sparselens::looks
