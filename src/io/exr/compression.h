// How the pixels of an EXR file are compressed: the names of the methods, and which of them a file may use.
#pragma once

#include "../../base/image.h"

#include <ImfCompression.h>
#include <ImfHeader.h>

#include <optional>
#include <span>
#include <string>

namespace sparselens {

struct NamedCompression {
    const char *name; // as OpenEXR and OpenImageIO spell it
    Imf::Compression value;
    bool deep;  // allowed for deep files (OpenEXR 3.1 to 3.5)
    bool exact; // keeps all bits of 32-bit floats
};

// All methods of the OpenEXR that this is compiled with: htj2k256 and htj2k32 from 3.4 on, lj2k and zstd from 3.5 on.
std::span<const NamedCompression> compressions();

// The names that flat or deep files may have, separated by `separator`.
std::string compression_names(bool deep, const std::string &separator);

// Says that a compression changed the ids of a channel, or that they are halves, which cannot hold them; else empty.
std::string why_ids_are_lost(Imf::Compression compression, const Channel &channel);

// The first channel of data that a compression changes as if it were a colour; empty if there is none.
std::string data_changed_by(Imf::Compression compression, std::span<const Channel> channels);

// The compression of a new file: the requested one; otherwise none into a pipe; otherwise that of `metadata` if it is
// the header of a file of the same kind (flat or deep); otherwise ZIP (flat), ZSTD (deep) or ZIPS (deep, before OpenEXR
// 3.5). The ids of a Cryptomatte need an exact method; if that of `metadata` is not exact, they get ZIP. Throws
// UsageError if a file with these channels may not have the requested one.
Imf::Compression output_compression(bool deep, std::optional<Imf::Compression> asked, bool to_pipe,
                                    const Imf::Header &metadata, std::span<const Channel> channels);

} // namespace sparselens
