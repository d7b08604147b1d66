// --device: which device works.
#pragma once

#include "harness/commands/cli.h"

#include <string>

namespace sparselens {

// `device`: a word as choose_device() has it; `list` is answered as --help is. `what_works`, for the help: "What warps".
void add_device_option(CLI::App &app, std::string &device, const std::string &what_works);

} // namespace sparselens
