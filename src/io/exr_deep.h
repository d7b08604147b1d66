// LDIs on disk: deep EXR (ours and anyone's, scanline or tiled), and flat pictures with depth read as LDIs of
// one sample a pixel. Layout: design.md section 2. `-` stands for standard input and output.
// Errors (Error): what cannot be opened, read or written, naming the file and the channel.
#pragma once

#include "ldi/ldi.h"

#include <ImfHeader.h>

#include <string>

namespace sparselens {

struct LdiFile {
    Ldi ldi;
    Imf::Header header;
    bool deep = true; // false: read from a flat picture
};

// The first deep part, else the first flat one. `depth_channel` empty: Z, depth.Z and *.Depth.Z are tried; NAMEBack
// beside it are the back depths. Samples come as they stand in the file (see tidy), of a flat picture one a pixel.
LdiFile read_ldi(const std::string &path, const std::string &depth_channel = {});

// Scanline deep EXR, ZIPS (into a pipe uncompressed); deepImageState says what holds of the samples. Of `metadata`
// everything is kept that does not describe its own pixels. Returns how many values became the largest half, as
// write_flat_exr does.
std::size_t write_ldi(const std::string &path, const Ldi &ldi, const Imf::Header &metadata);

} // namespace sparselens
