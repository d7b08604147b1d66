// The options that give the lens its looks.
#pragma once

#include "harness/commands/cli.h"
#include "io/lens_file.h"
#include "view/look_values.h"

#include <optional>
#include <string>

namespace sparselens {

struct LookOptions {
    LookValues values;
    std::string lens_file;     // looks under a name, below those that options give; empty: none
    std::string aperture_file; // of values.picture, which read_looks() reads; empty: none
};

// `options` must stay where it is until the command line is parsed.
void add_look_options(CLI::App &app, LookOptions &options);

// The name of the first look option that was given; empty if none was.
std::string first_look_option(const CLI::App &parsed);

// Reads the files that the options name, and puts the options' values over those of the lens file, whose name is kept. Throws
// as read_lens_file() and read_aperture_picture().
// A lens file's values may depend on the f-number.
LensFile read_looks(const LookOptions &options, std::optional<double> fstop);

} // namespace sparselens
