// Looks that change where the picture is sharp, and by how much it is magnified.
#pragma once

#include "look.h"

#include <numbers>
#include <utility>

namespace sparselens::looks {

// A plane of focus that is bent (lens/focus_field.h).
struct FieldCurvature {
    std::optional<double> field_curvature = {};

    static constexpr auto rows() {
        return std::array{LookRow<FieldCurvature>{{"field-curvature", "K",
                                                   "Curvature of the plane of focus, from -1 to 1: at the "
                                                   "corners, 1/d is 1 + K times as large (default: 0)",
                                                   &FieldCurvature::field_curvature, from_minus_1_to_1},
                                                  {"curved focus", -1, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const {
        looks.field_curvature = field_curvature.value_or(0);
    }
};

// Astigmatism: rays along and across a line through the axis come to focus at different distances (lens/focus_field.h).
struct Astigmatism {
    std::optional<double> astigmatism = {};

    static constexpr auto rows() {
        return std::array{LookRow<Astigmatism>{
            {"astigmatism", "A",
             "Astigmatism, from -1 to 1: at the corners, 1/d is 1 + A times as large for rays along a line "
             "through the axis, and 1 - A times for rays across it (default: 0)",
             &Astigmatism::astigmatism, from_minus_1_to_1},
            {"astigmatism", -1, 1}}};
    }
    void act(const LookContext &, LensLooks &looks) const { looks.astigmatism = astigmatism.value_or(0); }
};

// A plane of focus that is tilted, by two angles (lens/focus_field.h). A command line takes them as one pair, so they
// have no row here.
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

namespace sparselens {

// Axial chromatic aberration: colours that come to focus at other distances than green (lens/lens_looks.h).

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
        return std::array{LookRow<AxialChromatic>{
            {"axial-chromatic", "MM",
             "Colour fringes, in millimetres, from -5 to 5: where green is sharp, red focuses this far "
             "behind the sensor and blue as far in front of it (default: 0)",
             &AxialChromatic::axial_chromatic, within_5},
            {"colour fringes, mm", -5, 5}}};
    }
    void act(const LookContext &context, LensLooks &looks) const; // needs the focal length
};

} // namespace looks

} // namespace sparselens

namespace sparselens::looks {

// Focus breathing: the picture grows as the lens focuses nearer (lens/lens_looks.h).
struct Breathing {
    std::optional<double> breathing = {};

    static constexpr auto rows() {
        constexpr NumberRange to_2{"a number from 0 to 2", [](double v) { return v >= 0 && v <= 2; }};
        return std::array{
            LookRow<Breathing>{{"breathing", "B",
                                "Focus breathing, how much focusing magnifies the picture, from 0 to 2; 1: a "
                                "thin lens that moves as a whole (default: 0)",
                                &Breathing::breathing, to_2},
                               {"focus breathing", 0, 2}}};
    }
    // Needs the focal length. Throws UsageError if the lens cannot focus that near.
    void act(const LookContext &context, LensLooks &looks) const;
};

} // namespace sparselens::looks
