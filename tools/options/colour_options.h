// The colour options that tools share: the colour space of the input and that of the output.
#pragma once

#include "chain/colours.h"
#include "harness/commands/cli.h"

namespace sparselens {

void add_input_colour_options(CLI::App &app, ColourOptions &options);
void add_output_colour_options(CLI::App &app, ColourOptions &options); // of the output

} // namespace sparselens
