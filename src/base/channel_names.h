// How other programs spell colours. Nuke writes red, green, blue and alpha, of a layer too (beauty.red); others r, g, b and a.
// In any case they are R, G, B and A, by which all code knows them. Files keep their own names (io/exr/kept_names.h).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct Channel;

// R for red, RED and r; beauty.G for beauty.green; every other name as it is.
std::string colour_name(std::string_view name);

// The names by which the code knows channels, whose kinds are set: colour_name() of light and coverage, unless another
// channel has that name.
std::vector<std::string> names_of_colours(std::span<const Channel> channels);

} // namespace sparselens
