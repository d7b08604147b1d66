// Axial chromatic aberration: colours that come to focus at other distances than green (lens/lens_looks.h).
#pragma once

#include "look.h"

#include <utility>

namespace sparselens {

// Which colours focus at another distance than green: red behind the sensor and blue in front of it; only blue, in
// front; red and blue, behind.
enum class ChromaticType { red_blue, blue_yellow, green_magenta };

namespace looks {

struct AxialChromatic {
    std::optional<double> axial_chromatic = {}; // mm behind the sensor
    std::optional<ChromaticType> chromatic_type = {};

    static constexpr std::array<std::pair<const char *, ChromaticType>, 3> types{
        {{"red-blue", ChromaticType::red_blue},
         {"blue-yellow", ChromaticType::blue_yellow},
         {"green-magenta", ChromaticType::green_magenta}}};
    static constexpr auto rows() {
        constexpr NumberRange within_5{"a number from -5 to 5", [](double v) { return std::abs(v) <= 5; }};
        return std::array{LookRow<AxialChromatic>{{"axial-chromatic", "MM",
                                                   "Colour fringes: where green is sharp, red focuses this "
                                                   "far behind the sensor and blue as far in front "
                                                   "of it, from -5 to 5 mm (default: 0)",
                                                   &AxialChromatic::axial_chromatic, within_5},
                                                  {"colour fringes, mm", -5, 5}}};
    }
    void act(const LookContext &context, LensLooks &looks) const; // needs the focal length
};

} // namespace looks

} // namespace sparselens
