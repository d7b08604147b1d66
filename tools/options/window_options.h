// The options of a picture's pixels and size.
#pragma once

#include "harness/commands/cli.h"
#include "chain/gather_windows.h"

namespace sparselens {

void add_window_options(CLI::App &app, WindowOptions &options);

} // namespace sparselens
