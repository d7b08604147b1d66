#include "view/look_values.h"

#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr NumberRange blade_count{"0 or a whole number from 3 to 16", [](double v) {
                                      return v == 0 || (v >= 3 && v <= 16 && std::trunc(v) == v);
                                  }};
constexpr NumberRange share{"a number from 0 to 1", [](double v) { return v >= 0 && v <= 1; }};
constexpr NumberRange signed_share{"a number from -1 to 1", [](double v) { return std::abs(v) <= 1; }};
constexpr NumberRange angle{"a number of degrees", [](double v) { return std::abs(v) <= 1e6; }};
constexpr NumberRange to_100{"a number from 0 to 100", [](double v) { return v >= 0 && v <= 100; }};
constexpr NumberRange within_5{"a number from -5 to 5", [](double v) { return std::abs(v) <= 5; }};
constexpr NumberRange to_2{"a number from 0 to 2", [](double v) { return v >= 0 && v <= 2; }};
constexpr NumberRange stretch{"a number from 0.001 to 1000", [](double v) { return v >= 1e-3 && v <= 1e3; }};
constexpr NumberRange gain{"a number from 1 to 1000", [](double v) { return v >= 1 && v <= 1000; }};

constexpr std::array numbers{
    LookNumber{"blades", "N",
               "Number of blades, which is the number of corners of the aperture; 0: round (default: 0)",
               &LookValues::blades, blade_count},
    LookNumber{"blade-curvature", "C", "Curvature of the blades, from 0, straight, to 1, round (default: 0)",
               &LookValues::curvature, share},
    LookNumber{"blade-rotation", "DEG",
               "Rotation of the blades, in degrees counter-clockwise for a lamp behind focus; 0: the middle "
               "of a side is at the right (default: 0)",
               &LookValues::rotation, angle},
    LookNumber{"squeeze", "S",
               "Height of the aperture divided by its width, e.g. 2 for an anamorphic lens (default: 1)",
               &LookValues::squeeze, stretch},
    LookNumber{
        "spherical", "S",
        "Spherical aberration from -1 to 1: above 0, discs behind focus have bright rims and those in front "
        "bright cores (default: 0)",
        &LookValues::spherical, signed_share},
    LookNumber{"cat-eye", "A",
               "Cat's eye: a second circle cuts the aperture, displaced by A radii at the picture's corner "
               "(default: 0)",
               &LookValues::cat_eye, to_100},
    LookNumber{"axial-chromatic", "MM",
               "Colour fringes: where green is sharp, red focuses this far behind the sensor and blue as far "
               "in front of it, from -5 to 5 mm (default: 0)",
               &LookValues::axial_chromatic, within_5},
    LookNumber{"field-curvature", "K",
               "Bends the plane of focus, from -1 to 1: 1/d is 1 + K times as large at the picture's corners "
               "(default: 0)",
               &LookValues::field_curvature, signed_share},
    LookNumber{"astigmatism", "A",
               "Separates the focus of rays along and across a line through the axis, from -1 to 1: at the "
               "corners 1/d is 1 + A and 1 - A times as large (default: 0)",
               &LookValues::astigmatism, signed_share},
    LookNumber{"breathing", "B",
               "Focus breathing: magnification by focusing, from 0 to 2; 1 is a thin lens that moves as a "
               "whole (default: 0)",
               &LookValues::breathing, to_2},
};

constexpr std::array highlights{
    LookNumber{"highlight-gain", "G",
               "Make lights above the threshold up to G times as bright before the lens sees them, 1 to 1000 "
               "(default: 1)",
               &LookValues::highlight_gain, gain},
    LookNumber{"highlight-threshold", "Y", "Scene-linear luminance above which lights grow (default: 1)",
               &LookValues::highlight_threshold, at_least_0},
    LookNumber{"highlight-knee", "Y", "Luminance over which the gain sets in softly (default: 1)",
               &LookValues::highlight_knee, above_0},
};

constexpr std::array<std::pair<const char *, ChromaticType>, 3> chromatics{
    {{"red-blue", ChromaticType::red_blue},
     {"blue-yellow", ChromaticType::blue_yellow},
     {"green-magenta", ChromaticType::green_magenta}}};

} // namespace

std::span<const LookNumber> look_numbers() { return numbers; }
std::span<const LookNumber> highlight_numbers() { return highlights; }

std::span<const std::pair<const char *, ChromaticType>> chromatic_types() { return chromatics; }

bool is_tilt(double degrees) { return std::abs(degrees) <= 89; }

LookValues look_values_over(const LookValues &above, const LookValues &below) {
    LookValues both = above;
    for (const auto table : {look_numbers(), highlight_numbers()})
        for (const LookNumber &number : table)
            if (!(both.*number.value)) both.*number.value = below.*number.value;
    if (!both.picture && !above.blades) both.picture = below.picture;
    if (above.picture && !above.blades) both.blades.reset();
    if (!both.tilt_x) both.tilt_x = below.tilt_x, both.tilt_y = below.tilt_y;
    if (!both.chromatic_type) both.chromatic_type = below.chromatic_type;
    if (!both.cat_eye_darkening) both.cat_eye_darkening = below.cat_eye_darkening;
    return both;
}

} // namespace sparselens
