// The options that give the lens its looks.
#pragma once

#include "harness/commands/cli.h"
#include "view/look_values.h"

#include <string>
#include <vector>

namespace sparselens {

struct LookOptions {
    LookValues values;
    std::string aperture_file; // of values.picture, which read_looks() reads; empty: none
};

// `options` must stay where it is until the command line is parsed.
void add_look_options(CLI::App &app, LookOptions &options);

// The name of the first look option that was given; empty if none was.
std::string first_look_option(const CLI::App &parsed);

// Reads the files that the options name. Throws Error as read_aperture_picture().
LookValues read_looks(const LookOptions &options);

} // namespace sparselens
