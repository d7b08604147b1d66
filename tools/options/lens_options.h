// The lens options that every tool shares.
#pragma once

#include "harness/one_line.h"
#include "io/lens_file.h"
#include "io/open_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <string>
#include <vector>

namespace sparselens {

void add_lens_options(CLI::App &app, LensValues &values);
void add_depth_options(CLI::App &app, DepthOptions &options); // including the choice of the picture
// How many pixels of the files, along one side, make one pixel of the picture.
void add_subpixels_option(CLI::App &app, std::optional<int> &across);
void add_picture_choice(CLI::App &app, PictureChoice &picture);

// --depth-file: for the one picture that a tool reads, or for each of several.
void add_depth_file_option(CLI::App &app, std::string &file);
void add_depth_files_option(CLI::App &app, std::vector<std::string> &files);

CLI::Validator number(NumberRange range);

// Adds the option of a table's entry.
template <typename Values>
CLI::Option *add_number(CLI::App &app, const NumberParameter<Values> &of, Values &values) {
    return app.add_option(fmt::format("--{}", of.name), values.*of.value, with_options(of.help))
        ->type_name(of.unit)
        ->check(number(of.range));
}

// Adds the looks of the lens. `given` must not move until the command line is parsed.
void add_look_options(CLI::App &app, GivenLooks &given);

// Adds --highlight-gain and related options.
void add_highlight_options(CLI::App &app, GivenLooks &given);

} // namespace sparselens
