// The colour options that tools share: the colour space of the input and that of the output.
#pragma once

#include "deep/ldi.h"
#include "harness/tool.h"
#include "io/display/colour.h"
#include "view/view.h"

#include <CLI/CLI.hpp>
#include <ImfHeader.h>

#include <string>

namespace sparselens {

struct ColourOptions {
    std::string config, input_space;         // --colorconfig, --colorspace
    std::string output_space, display, view; // --output-colorspace; --display, --view-transform
};

void add_input_colour_options(CLI::App &app, ColourOptions &options);
void add_output_colour_options(CLI::App &app, ColourOptions &options); // of the output

// Converts the colours of a file to scene-linear, from --colorspace. Without it, files of these tools are scene-linear,
// and the file rules of the configuration name the colour space of other files.
void to_scene_linear(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                     const Imf::Header &header, Ldi &ldi);
void to_scene_linear(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                     const Imf::Header &header, View &view);

// Writes a picture of scene-linear colours: as OpenEXR in --output-colorspace (default: scene-linear); as PNG, JPEG,
// TIFF and the like in --output-colorspace, else through --display and --view-transform (default: those of the
// configuration). Throws UsageError for a display with an OpenEXR file. Returns what write_flat_exr returns.
std::size_t write_picture(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                          Image image, const Imf::Header &metadata);

} // namespace sparselens
