// LDIs on disk: deep EXR files (of any program, scanline or tiled), and flat pictures with depth, read as LDIs of one
// sample per pixel. docs/file-format.md describes the layout. `-` stands for standard input and output.
#pragma once

#include "../../deep/ldi.h"
#include "../../deep/packed_rows.h"
#include "compression.h"
#include "exr_parts.h"

#include <ImfHeader.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct LdiFile {
    Ldi ldi;
    Imf::Header header;
    bool deep = true;                      // false: the file is a flat picture
    std::vector<std::string> notes;        // how channels were interpreted and several parts were combined
    std::vector<std::string> warnings;     // likely mistakes
    std::optional<PackedRows> packed = {}; // the samples, in place of those of `ldi`
};

// Reads the deep parts of one view of the file, or if it has none, the flat ones (read_flat_exr). If there are several
// deep parts:
// - a part with samples at the same positions as another part, or without depth and with as many samples in every
//   pixel, is a layer (an AOV) of that part: R of the part "diffuse" becomes diffuse.R;
// - every other part is an object, and the picture has the samples of all of them (see deep_merge());
// - but if exactly one part has the name of a beauty (exr_parts.h), that part is the whole picture, and parts that are
//   not layers of it are left out.
// If no part has a channel R, G or B, a layer with the name of a beauty (exr_channels.h) becomes R, G, B and A. If the
// choice names a layer, only its channels are read, and those that belong to no picture (exr_channels.h). Throws
// UsageError if one part holds several beauties and the choice names none. A missing A is made from AR, AG and AB. Back
// depths are in the channel NAMEBack beside the depth channel. Samples are returned as they stand in the file (see
// tidy); a flat picture has one per pixel.
LdiFile read_ldi(const std::string &path, const PictureChoice &choice = {});

// The same with less memory, if fewer samples are needed. `reduce` gets a few rows at a time, from several threads at
// once, and its result is kept; it may not change the windows. If it returns nothing, it is not called again, and the
// result has no samples. Samples that would take more than memory_to_gather() are kept packed. `reduce` is not called
// if the picture has several parts or tiles, or is flat; the result then has all samples.
using ReduceFileRows = std::function<std::optional<Ldi>(const Imf::Header &header, Ldi rows)>;
LdiFile read_ldi(const std::string &path, const PictureChoice &choice, const ReduceFileRows &reduce);

// Writes a scanline deep EXR file, compressed as compression.h says; without deepImageState, because OpenEXR's module
// for Python opens no file that has it. Keeps all of `metadata` that does not describe its own pixels. Returns the
// number of values that became the largest half, as write_flat_exr does.
std::size_t write_ldi(const std::string &path, const Ldi &ldi, const Imf::Header &metadata,
                      std::optional<Imf::Compression> compression = {});

} // namespace sparselens
