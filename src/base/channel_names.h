// Channels by their names: which are of one layer, and how other programs spell colours. Nuke writes red, green, blue
// and alpha, also in layers (beauty.red); other programs write r, g, b and a. In this code they are always R, G, B and
// A. Files keep their own names (io/exr/kept_names.h).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct Channel;

// Returns R for red, RED and r, and beauty.G for beauty.green. Returns every other name unchanged.
std::string colour_name(std::string_view name);

// The names by which the code knows the channels. The kinds of the channels must be set. Light and coverage get their
// colour_name(), unless another channel has that name.
std::vector<std::string> names_of_colours(std::span<const Channel> channels);

// Groups the indices of the channels of light that may be calculated with. R, G and B of one layer form a group, in the
// order of the channels; every other channel, coverage too, is a group of its own.
std::vector<std::vector<std::size_t>> colour_layers(std::span<const Channel> channels);

} // namespace sparselens
