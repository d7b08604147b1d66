// Flat EXR files: any part layout, scanline or tiled, any compression; every channel comes as float in memory.
//
// Metadata travels as OpenEXR's own header, untouched. `-` stands for standard input and output.
// Errors (Error): what cannot be opened, read or written, naming the file and the channel.
#pragma once

#include "../../base/image.h"

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <string>

namespace sparselens {

struct FlatFile {
    Image image;
    Imf::Header header;          // of the part the channels came from
    std::uint64_t file_size = 0; // bytes: what it may ask memory for, see check_memory()
};

// The flat parts of one view of the file as one picture: the beauty (by its part's name, else the first part), then
// all others of its windows, a channel whose name is taken as one of its part's layer. `stereo_view` empty: the
// file's default view (see exr_parts.h); A is made of AR, AG, AB where it is missing (see coloured_alpha.h).
FlatFile read_flat_exr(const std::string &path, const std::string &stereo_view = {});
// Of the beauty's part, without reading pixels.
Imf::Header read_flat_header(const std::string &path, const std::string &stereo_view = {});
// `path`: for messages; `size` of the file, bytes.
FlatFile read_flat_part(Imf::MultiPartInputFile &file, const std::string &path, std::uint64_t size,
                        const std::string &stereo_view);

// Takes the depth channel out of the picture (see read_ldi for how it is found), and drops what else says where
// a sample lies (see is_position_channel), which is nothing to be carried like a colour.
std::vector<float> take_depth(Image &image, const std::string &depth_channel, const std::string &path);

// Channels are stored in their own types. Of `metadata` everything is kept that does not describe the pixels
// themselves (windows, channels, tiling); compression is ZIP. Returns how many values were
// beyond what a half holds and became its largest, 65504.
std::size_t write_flat_exr(const std::string &path, const Image &image, const Imf::Header &metadata);

} // namespace sparselens
