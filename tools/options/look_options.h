// The options that give the lens its looks.
#pragma once

#include "harness/commands/cli.h"
#include "io/lens_file.h"

namespace sparselens {

// `given` must stay where it is until the command line is parsed.
void add_look_options(CLI::App &app, GivenLooks &given);

// --highlight-gain and what goes with it.
void add_highlight_options(CLI::App &app, GivenLooks &given);

} // namespace sparselens
