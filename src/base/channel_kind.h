// The kind of a channel decides what may be done with its values. Only this file decides the kind.
//
//   light     colour and coverage: they are averaged; small bright ones are spread exactly, those near focus sharpened
//   data      normals, positions, UV, motion, further depths: they are only averaged
//   ids       integers, layers with names of ids (below), and pairs of a Cryptomatte (matte.h): they are only copied
//
// A channel holds data if it is the X, Y, Z, U, V or W of a layer (Y only beside X: alone it is luminance), or Z or
// ZBack, or if its layer has a name of data: N, P, uv and the like, or a name with such a word (VRayNormals,
// world_position, motionVector, Pworld). It holds ids if its layer is named IndexOB, objectid, *ID, ... and has no
// colours. Users can state what a name does not tell.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct Channel;

// A channel of integers holds ids whatever its kind. Floats in a layer named as ids are data that holds_ids().
enum class ChannelKind { light, data, matte_id, matte_coverage };

bool holds_ids(const Channel &channel);
bool is_in_matte(const Channel &channel);
bool is_light(const Channel &channel); // coverage too

// Which colour a channel of light is, by the last part of its name, so that layers have colours, too.
enum class ColourPart { none, red, green, blue, coverage };
ColourPart colour_part(const Channel &channel);

// Names of layers, or of channels, whose kind the user states; the last part of a layer's name is enough.
struct StatedKinds {
    std::vector<std::string> data = {}, light = {};
};
bool is_named(const Channel &channel, std::string_view name);

// Sets the kind of each channel. `mattes` are the names that the header gives to Cryptomattes; layers of floats whose
// names contain "crypto" and end in two digits are ranks of one, too.
void find_kinds(std::span<Channel> channels, std::span<const std::string> mattes = {},
                const StatedKinds &stated = {});

// Channels by their names: which are of one layer, and how other programs spell colours. Nuke writes red, green, blue
// and alpha, also in layers (beauty.red); other programs write r, g, b and a. In this code they are always R, G, B and
// A. Files keep their own names (io/exr/exr_common.h).

// Returns R for red, RED and r, and beauty.G for beauty.green. Returns every other name unchanged.
std::string colour_name(std::string_view name);

// The names by which the code knows the channels. The kinds of the channels must be set. Light and coverage get their
// colour_name(), unless another channel has that name. RA, GA and BA, if all three exist, are AR, AG and AB
// (deep/channel_alpha.h).
std::vector<std::string> names_of_colours(std::span<const Channel> channels);

// Groups the indices of the channels of light that may be calculated with. R, G and B of one layer form a group, in the
// order of the channels; every other channel, coverage too, is a group of its own.
std::vector<std::vector<std::size_t>> colour_layers(std::span<const Channel> channels);

} // namespace sparselens
