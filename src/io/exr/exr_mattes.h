// The Cryptomattes that headers name (base/matte.h). Not for use outside io/.
#pragma once

#include "base/image.h"
#include "io/exr/exr_parts.h"

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <span>
#include <string>
#include <vector>

namespace sparselens {

// The attributes cryptomatte/.../name.
std::vector<std::string> matte_names(const Imf::Header &header);

// The header with the attributes cryptomatte/... of all parts, because mattes may lie in their own parts.
Imf::Header with_mattes_of(const Imf::MultiPartInputFile &file, Imf::Header header);

// Sets the kinds of channels (base/channel_kind.h) by their names and by the mattes that the header names.
void find_kinds_by(const Imf::Header &header, std::span<Channel> channels);
void find_kinds_by(const Imf::Header &header, std::vector<FileChannel> &channels);

} // namespace sparselens
