// Files keep the names of their channels. If the code knows a channel by another name (base/channel_names.h: red is R),
// an attribute of the header in memory records its name in files. The attribute is never written; in files the channels
// have their own names. Not for use outside io/ and python/.
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

// Gives channels the names by which the code knows them, and records their original names in the header.
void name_colours(std::span<Channel> channels, Imf::Header &header);

// The channels by their names in a file with this metadata. All names are different.
std::vector<Channel> by_kept_names(std::span<const Channel> channels, const Imf::Header &metadata);

} // namespace sparselens
