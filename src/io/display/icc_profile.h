// ICC profiles of R, G and B that consist of three curves and a matrix, as cameras and phones write them (ICC.1:2010):
// Display P3, Adobe RGB. Profiles of tables are carried along, but not understood.
#pragma once

#include "io/display/colour.h"

#include <optional>
#include <string>
#include <string_view>

namespace sparselens {

// Whether the bytes are a profile for R, G and B.
bool is_rgb_profile(std::string_view bytes);

// From the colours of the profile to linear ones of Rec.709, which may then be below 0, or back. Empty if it does not
// consist of curves and a matrix.
enum class ProfileDirection { to_linear, from_linear };
std::optional<ColourTransform> transform_of_profile(const std::string &bytes, ProfileDirection direction);

} // namespace sparselens
