// The lens options that every tool shares.
#pragma once

#include "harness/commands/cli.h"
#include "io/open_options.h"

#include <string>

namespace sparselens {

void add_lens_options(CLI::App &app, LensValues &values);
void add_depth_options(CLI::App &app, DepthOptions &options); // the choice of the picture among them
void add_picture_choice(CLI::App &app, PictureChoice &picture);

// What is neither 0 nor below (nor infinite, unless allowed). CLI11 reads "inf" and "nan" as numbers; the second is
// never meant.
struct NumberRange {
    bool zero_allowed = false, infinity_allowed = false;
};
CLI::Validator number(const std::string &what, NumberRange range = {});

} // namespace sparselens
