// Finds the depth channel of a picture. Only this file knows the names that programs give it. Not for use outside io/.
//
// The first of these that exists, in any case: Z; depth.Z; *.Depth.Z; a channel, or the first of a layer, named z,
// depth or zdepth (Z.R, depth.V, zDepth.R). Otherwise it guesses, with a warning: the only LAYER.Z without a LAYER.X,
// or the only channel with "depth" in its name.
#pragma once

#include "base/image.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct FlatFile;      // io/exr/exr_flat.h
struct PictureChoice; // io/exr/picture_choice.h

struct DepthChannel {
    std::string name;
    std::optional<std::string> warning = {}; // if it is a guess
};

// The channel `asked`, in any case if none is spelled exactly so; if `asked` is empty, the channel found by its name.
// Throws Error, listing the channels, if there is none, or if it holds integers.
DepthChannel find_depth_channel(const std::vector<Channel> &channels, const std::string &asked,
                                const std::string &path);

// Whether there is a depth channel, of any type, that need not be guessed.
bool has_depth_channel(const std::vector<Channel> &channels, const std::string &asked);

// How clearly the name means depth: 0 for Z, more for less clear names; empty if it does not.
std::optional<int> depth_rank(std::string_view name);

// Reads the depth of choice.depth_file and puts it into the picture as Z, in place of any depth there. Notes and
// warnings name what it read. The depth is the channel found by its name; otherwise the only channel;
// otherwise the first of R, G and B. Outside its data window it is 0. Throws Error if the file has no depth, or differs
// from the picture in display window or pixel aspect ratio.
void put_depth_of_file(FlatFile &picture, const std::string &path, const PictureChoice &choice);

} // namespace sparselens
