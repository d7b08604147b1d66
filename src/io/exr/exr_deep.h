// LDIs on disk: deep EXR (ours and anyone's, scanline or tiled), and flat pictures with depth read as LDIs of
// one sample a pixel. Layout: design.md section 2. `-` stands for standard input and output.
// Errors (Error): what cannot be opened, read or written, naming the file and the channel.
#pragma once

#include "../../deep/ldi.h"

#include <ImfHeader.h>

#include <string>
#include <vector>

namespace sparselens {

struct LdiFile {
    Ldi ldi;
    Imf::Header header;
    bool deep = true;               // false: read from a flat picture
    std::vector<std::string> notes; // what was made of the parts, where there are several
};

// The deep parts of one view of the file, else the flat ones (read_flat_exr). Of several deep parts:
// - one that has its samples where another has, or no depth and as many in every pixel, is a layer of it (an AOV):
//   R of the part "diffuse" becomes diffuse.R;
// - the others are an object each, and all their samples are in the picture (see deep_merge());
// - but where just one bears a beauty's name (exr_parts.h), that is the whole picture, and what is no layer of it
//   is left out.
// `stereo_view` empty: the default view (exr_parts.h). A is made of AR, AG, AB where it is missing. `depth_channel`
// empty: Z, depth.Z and *.Depth.Z are tried; NAMEBack beside it are the back depths. Samples come as they stand in
// the file (see tidy), of a flat picture one a pixel.
LdiFile read_ldi(const std::string &path, const std::string &depth_channel = {},
                 const std::string &stereo_view = {});

// Scanline deep EXR, ZIPS (into a pipe uncompressed); deepImageState says what holds of the samples. Of `metadata`
// everything is kept that does not describe its own pixels. Returns how many values became the largest half, as
// write_flat_exr does.
std::size_t write_ldi(const std::string &path, const Ldi &ldi, const Imf::Header &metadata);

} // namespace sparselens
