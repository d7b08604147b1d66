// Which channel of a picture is its depth. This is the one place that knows the names that programs give it. Not for use
// outside io/.
//
// In any case, and the first that is there: Z; depth.Z; *.Depth.Z; a channel, or the first of a layer, named z, depth or
// zdepth (Z.R, depth.V, zDepth.R). Else it is a guess, which is said: the only LAYER.Z without a LAYER.X, or the only channel
// with "depth" in its name.
#pragma once

#include "base/image.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct DepthChannel {
    std::string name;
    std::optional<std::string> warning = {}; // where it is a guess
};

// `asked`, in any case where none is spelled so, or if that is empty the one that the names tell. Throws Error where there is
// none, listing the channels, or where it holds integers.
DepthChannel find_depth_channel(const std::vector<Channel> &channels, const std::string &asked,
                                const std::string &path);

// Whether there is a depth channel, of any type, without a guess.
bool has_depth_channel(const std::vector<Channel> &channels, const std::string &asked);

// How clearly the name is that of a depth: 0 for Z, more for less clear ones; none: it is not.
std::optional<int> depth_rank(std::string_view name);

} // namespace sparselens
