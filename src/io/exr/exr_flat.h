// Flat EXR files of any part layout and compression, scanline or tiled. In memory every channel is float.
//
// Metadata is carried in the header of OpenEXR, unchanged. `-` stands for standard input and output.
#pragma once

#include "../../base/image.h"
#include "compression.h"
#include "exr_parts.h"

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct FlatFile {
    Image image;
    Imf::Header header;                  // of the part with the beauty
    std::uint64_t file_size = 0;         // bytes; limits the memory that it may ask for, see check_memory()
    std::vector<std::string> notes = {}; // how channels were interpreted
    std::vector<std::string> warnings = {}; // likely mistakes
};

// Reads the flat parts of one view of the file, or the channels of one layer of it, as one picture: the beauty (by the
// name of the part, or else the first part), then all other parts with the same display window. The data window
// contains those of all parts; outside its own, a part is 0, which as a depth means nothing. Warnings name parts that
// are not used. A channel whose name is taken becomes a channel of the layer of its part. If nothing is named R, G or
// B, the layer with the name of a beauty is read as the beauty (exr_channels.h: ViewLayer.Combined, Ci). Throws
// UsageError if there are several and the choice names none. A missing A is made from AR, AG and AB (see
// channel_alpha.h).
FlatFile read_flat_exr(const std::string &path, const PictureChoice &choice = {});
// The header of the part with the beauty, without reading pixels.
Imf::Header read_flat_header(const std::string &path, const PictureChoice &choice = {});
// Whether it is a file that can be read twice, and has only deep parts.
bool is_deep_alone(const std::string &path);
// `path` is for messages; `size`: bytes of the file.
FlatFile read_flat_part(Imf::MultiPartInputFile &file, const std::string &path, std::uint64_t size,
                        const PictureChoice &choice);

// Takes the depth channel out of the picture (see read_ldi for how it is found) and drops the other channels with
// positions of samples (see is_position_channel), which must not be carried along like colours.
std::vector<float> take_depth(Image &image, const std::string &depth_channel, const std::string &path);

// Stores channels in their own types, compressed as compression.h says. Keeps all of `metadata` that does not describe
// the pixels themselves (windows, channels, tiling). `tiles`: width and height of tiles in pixels; 0: scanlines.
// Returns the number of values beyond the range of half, which became its largest value, 65504.
std::size_t write_flat_exr(const std::string &path, const Image &image, const Imf::Header &metadata,
                           std::optional<Imf::Compression> compression = {}, int tiles = 0);
// Returns the bytes of that file; `name` is for messages.
std::string flat_exr(const std::string &name, const Image &image, const Imf::Header &metadata,
                     std::optional<Imf::Compression> compression = {}, int tiles = 0);

// The channels of the image by their names in that file.
std::vector<Channel> channels_in_file(const Image &image, const Imf::Header &metadata);
// Returns the values that the file has for the pixels of `box`, which must lie within the data window: row by row, each
// pixel with these channels of the image, in their own types.
std::string stored_pixels(const Image &image, const Imath::Box2i &box, std::span<const std::size_t> channels);

} // namespace sparselens
