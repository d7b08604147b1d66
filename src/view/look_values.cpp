#include "view/look_values.h"

#include <array>
#include <cmath>

namespace sparselens {

namespace {

bool is_blades(double v) { return v == 0 || (v >= 3 && v <= 16 && std::trunc(v) == v); }
bool is_share(double v) { return v >= 0 && v <= 1; }
bool is_signed_share(double v) { return std::abs(v) <= 1; }
bool is_angle(double v) { return std::abs(v) <= 1e6; }
bool is_cat_eye(double v) { return v >= 0 && v <= 100; }
bool is_chromatic(double v) { return std::abs(v) <= 5; }
bool is_breathing(double v) { return v >= 0 && v <= 2; }
bool is_squeeze(double v) { return v >= 1e-3 && v <= 1e3; }
bool is_gain(double v) { return v >= 1 && v <= 1000; }
bool is_luminance(double v) { return v >= 0 && std::isfinite(v); }
bool is_positive(double v) { return v > 0 && std::isfinite(v); }

constexpr std::array numbers{
    LookNumber{"blades", "N", "Number of blades: the corners of the aperture; 0: round (default: 0)",
               &LookValues::blades, "0 or a whole number from 3 to 16", is_blades},
    LookNumber{"blade-curvature", "C", "Curvature of the blades, from 0, straight, to 1, round (default: 0)",
               &LookValues::curvature, "a number from 0 to 1", is_share},
    LookNumber{
        "blade-rotation", "DEG",
        "Rotation of the blades, degrees counter-clockwise as a lamp behind focus shows it; 0: a side's "
        "middle is to the right (default: 0)",
        &LookValues::rotation, "a number of degrees", is_angle},
    LookNumber{"squeeze", "S",
               "How many times higher than wide the aperture is, e.g. 2 for an anamorphic lens (default: 1)",
               &LookValues::squeeze, "a number from 0.001 to 1000", is_squeeze},
    LookNumber{
        "spherical", "S",
        "Spherical aberration from -1 to 1: above 0, discs behind focus have bright rims and those in front "
        "bright cores (default: 0)",
        &LookValues::spherical, "a number from -1 to 1", is_signed_share},
    LookNumber{"cat-eye", "A",
               "Cat's eye: how many radii a second circle that cuts the aperture is displaced at the "
               "picture's corner "
               "(default: 0)",
               &LookValues::cat_eye, "a number from 0 to 100", is_cat_eye},
    LookNumber{"axial-chromatic", "MM",
               "How far behind the sensor red comes to focus where green is sharp, from -5 to 5 mm; blue as "
               "far before "
               "it (default: 0)",
               &LookValues::axial_chromatic, "a number from -5 to 5", is_chromatic},
    LookNumber{
        "field-curvature", "K",
        "Bends the plane of focus, from -1 to 1: 1/d grows by K of itself towards the picture's corners "
        "(default: 0)",
        &LookValues::field_curvature, "a number from -1 to 1", is_signed_share},
    LookNumber{"astigmatism", "A",
               "Parts the foci of rays along and across a line through the axis, from -1 to 1: 1/d grows and "
               "shrinks by A of itself towards the corners (default: 0)",
               &LookValues::astigmatism, "a number from -1 to 1", is_signed_share},
    LookNumber{
        "breathing", "B",
        "Magnification by focusing, from 0 to 2: 1 is that of a thin lens that moves as a whole (default: 0)",
        &LookValues::breathing, "a number from 0 to 2", is_breathing},
};

constexpr std::array highlights{
    LookNumber{"highlight-gain", "G",
               "Make lights above the threshold up to G times as bright before the lens sees them, 1 to 1000 "
               "(default: 1)",
               &LookValues::highlight_gain, "a number from 1 to 1000", is_gain},
    LookNumber{"highlight-threshold", "Y", "Scene-linear luminance above which lights grow (default: 1)",
               &LookValues::highlight_threshold, "a number of at least 0", is_luminance},
    LookNumber{"highlight-knee", "Y", "Luminance over which the gain sets in softly (default: 1)",
               &LookValues::highlight_knee, "a number above 0", is_positive},
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
