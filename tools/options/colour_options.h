// The colour options that tools share: which space a file is in, and how a picture leaves.
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
void add_output_colour_options(CLI::App &app, ColourOptions &options); // those too

// Colours of a file to scene-linear: from --colorspace; else our own files are scene-linear, and of others the
// configuration's file rules say what they are.
void to_scene_linear(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                     const Imf::Header &header, Ldi &ldi);
void to_scene_linear(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                     const Imf::Header &header, View &view);

// Writes a picture of scene-linear colours: to OpenEXR in --output-colorspace (else scene-linear), to PNG, JPEG, TIFF
// and the like in --output-colorspace, else through --display and --view-transform (else the configuration's
// defaults). UsageError: a display for an OpenEXR file. Returns what write_flat_exr does.
std::size_t write_picture(const ToolContext &tool, const ColourOptions &options, const std::string &path,
                          Image image, const Imf::Header &metadata);

} // namespace sparselens
