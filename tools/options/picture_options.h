// Options of the tools that write pictures.
#pragma once

#include "base/image.h"
#include "chain/parameters.h"
#include "chain/take_picture.h"
#include "harness/commands/cli.h"
#include "io/display/shown_picture.h"
#include "io/exr/compression.h"

#include <optional>
#include <string>

namespace sparselens {

// Parses the X,Y of --view: scene units, x right, y up. Throws UsageError if the text is not X,Y.
Imath::V2d view_offset(const std::string &text);

// Adds --compression, with the names that flat or deep files allow; if empty, output_compression() decides.
using AskedCompression = std::optional<Imf::Compression>;
void add_compression_option(CLI::App &app, AskedCompression &compression, bool deep);

// Adds --recolor FILE: see deep/recolor.h.
void add_recolor_option(CLI::App &app, std::string &path);

// Adds --tiles N: EXR in tiles of N x N pixels, instead of scanlines.
void add_tiles_option(CLI::App &app, int &tiles);

// Checks the name of an output before any work is done.
CLI::Validator output_name(OutputKind kind);

// Adds -d half|float: the type of the written channels; if empty, the input's type.
void add_type_option(CLI::App &app, std::optional<PixelType> &type);
Image in_type(Image image,
              std::optional<PixelType> type); // all channels except ids, which are integers

// Adds --device. `device`: a word for choose_device() of gpu/device_list.h; `list` is answered as --help is.
// `what_works` begins the help text: "What warps".
void add_device_option(CLI::App &app, std::string &device, const std::string &what_works);

// Options made from the table of parameters (chain/parameters.h).

// Adds the option of a parameter, whose text goes to `put`, with what it excludes and needs among the options that are
// there. A device has an option of its own (add_device_option).
void add_parameter(CLI::App &app, const Parameter &row, std::function<bool(const std::string &)> put);

// `values` must not move until the command line is parsed.
template <typename Values>
void add_parameters(CLI::App &app, ParameterRows<Values> rows, Values &values) {
    for (const ParameterOf<Values> &row : rows)
        add_parameter(app, row, [&](const std::string &text) { return row.put(values, text); });
}

// How a file is opened: its depth, and which of its pictures.
void add_depth_options(CLI::App &app, DepthOptions &options);

// --depth-file for each of several pictures, and how many pixels of the files, along one side, make one of the picture.
void add_depth_files_option(CLI::App &app, std::vector<std::string> &files);
void add_subpixels_option(CLI::App &app, std::optional<int> &across);

// Checks that a text is a number in the range.
CLI::Validator number(NumberRange range);

} // namespace sparselens
