// Files keep the names of their channels. Where the code knows a channel by another name (base/channel_names.h: red is R), an
// attribute of the header in memory says its name in files. It is never written: the channels themselves say it there.
// Not for use outside io/ and python/.
#pragma once

#include "base/image.h"

#include <ImfHeader.h>

#include <map>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

inline constexpr const char *kept_names_attribute = "sparselens:channelNames";

using KeptNames = std::map<std::string, std::string>; // R: red

void set_kept_names(Imf::Header &header, const KeptNames &names);

// Gives channels the names by which the code knows them, and says in the header which names they had.
void name_colours(std::span<Channel> channels, Imf::Header &header);

// The channels by their names in a file with this metadata. Every channel has a name of its own.
std::vector<Channel> by_kept_names(std::span<const Channel> channels, const Imf::Header &metadata);

} // namespace sparselens
