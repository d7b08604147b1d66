// What options, a lens file and a picture's header say of the looks of a lens, each by the same table of names and
// ranges. What none of them says is as in LensLooks, into which resolve_looks.h makes them.
#pragma once

#include "../lens/aperture_shape.h"
#include "number_parameter.h"

#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace sparselens {

// Which colours focus off the green's plane: red behind the sensor and blue before it; only blue, before it; red and
// blue, behind it.
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
std::span<const LookNumber> look_numbers();      // what the lens does
std::span<const LookNumber> highlight_numbers(); // what makes lights brighter before it, whichever lens it is

// By their names.
std::span<const std::pair<const char *, ChromaticType>> chromatic_types();

bool is_tilt(double degrees); // between -89 and 89

// `above` where it says something, else `below`. Blades above a picture replace it, and the other way round.
LookValues look_values_over(const LookValues &above, const LookValues &below);

} // namespace sparselens
