// The options of a picture's pixels and size.
#pragma once

#include "chain/gather_windows.h"
#include "harness/commands/cli.h"

namespace sparselens {

void add_window_options(CLI::App &app, WindowOptions &options);

} // namespace sparselens
