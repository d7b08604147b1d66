// The looks of a lens as options, a lens file or a picture's header give them, with one table of names and ranges.
// resolve_looks.h turns them into LensLooks, whose defaults apply where a value is missing.
#pragma once

#include "../lens/aperture_shape.h"
#include "number_parameter.h"

#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace sparselens {

// Which colours focus at another distance than green: red behind the sensor and blue in front of it; only blue, in
// front; red and blue, behind.
enum class ChromaticType { red_blue, blue_yellow, green_magenta };

struct LookValues {
    std::optional<double> blades = {}, curvature = {}, rotation = {}, squeeze = {}, spherical = {};
    std::optional<double> cat_eye = {}, field_curvature = {}, astigmatism = {}, breathing = {};
    std::optional<double> tilt_x = {}, tilt_y = {}; // degrees
    std::optional<double> axial_chromatic = {};     // mm behind the sensor
    std::optional<ChromaticType> chromatic_type = {};
    std::optional<bool> cat_eye_darkening = {};
    std::optional<double> highlight_gain = {}, highlight_threshold = {},
                          highlight_knee = {}; // deep/highlight_gain.h
    std::shared_ptr<const AperturePicture> picture = {};
};

using LookNumber = NumberParameter<LookValues>;
std::span<const LookNumber> look_numbers();      // effects of the lens
std::span<const LookNumber> highlight_numbers(); // brighter lights, applied before any lens

// The types by name.
std::span<const std::pair<const char *, ChromaticType>> chromatic_types();

bool is_tilt(double degrees); // between -89 and 89

// The values of `above`; values that it lacks come from `below`. Blades in one replace an aperture picture in the
// other, and vice versa.
LookValues look_values_over(const LookValues &above, const LookValues &below);

} // namespace sparselens
