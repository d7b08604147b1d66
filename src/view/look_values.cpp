#include "view/look_values.h"

#include <array>
#include <cmath>

namespace sparselens {

namespace {

bool is_blades(double v) { return v == 0 || (v >= 3 && v <= 16 && std::trunc(v) == v); }
bool is_share(double v) { return v >= 0 && v <= 1; }
bool is_signed_share(double v) { return std::abs(v) <= 1; }
bool is_angle(double v) { return std::abs(v) <= 1e6; }
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
               &LookValues::squeeze, "a number above 0", is_positive},
    LookNumber{
        "spherical", "S",
        "Spherical aberration from -1 to 1: above 0, discs behind focus have bright rims and those in front "
        "bright cores (default: 0)",
        &LookValues::spherical, "a number from -1 to 1", is_signed_share},
};

} // namespace

std::span<const LookNumber> look_numbers() { return numbers; }

LookValues look_values_over(const LookValues &above, const LookValues &below) {
    LookValues both = above;
    for (const LookNumber &number : numbers)
        if (!(both.*number.value)) both.*number.value = below.*number.value;
    if (!both.picture && !above.blades) both.picture = below.picture;
    return both;
}

LensLooks looks_of(const LookValues &values) {
    LensLooks looks;
    ApertureShape &shape = looks.aperture;
    shape.blades = int(values.blades.value_or(0));
    shape.curvature = values.curvature.value_or(shape.curvature);
    shape.rotation = values.rotation.value_or(shape.rotation);
    shape.squeeze = values.squeeze.value_or(shape.squeeze);
    shape.spherical = values.spherical.value_or(shape.spherical);
    shape.picture = values.picture;
    return looks;
}

} // namespace sparselens
