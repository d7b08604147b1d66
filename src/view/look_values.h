// What options, a lens file and a picture's header say of the looks of a lens, each by the same table of names and
// ranges. What none of them says is as in LensLooks.
#pragma once

#include "../lens/lens_looks.h"

#include <memory>
#include <optional>
#include <span>

namespace sparselens {

struct LookValues {
    std::optional<double> blades = {}, curvature = {}, rotation = {}, squeeze = {}, spherical = {};
    std::shared_ptr<const AperturePicture> picture = {};
};

// One that is a number.
struct LookNumber {
    const char *name; // of the option, and in a lens file, without dashes
    const char *unit, *help;
    std::optional<double> LookValues::*value;
    const char *range; // in words
    bool (*valid)(double);
};

std::span<const LookNumber> look_numbers();

// `above` where it says something, else `below`. Blades above a picture replace it, and the other way round.
LookValues look_values_over(const LookValues &above, const LookValues &below);

LensLooks looks_of(const LookValues &values);

} // namespace sparselens
