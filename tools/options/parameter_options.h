// Options made from the table of parameters (chain/parameters.h).
#pragma once

#include "chain/parameters.h"
#include "harness/commands/cli.h"

namespace sparselens {

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
