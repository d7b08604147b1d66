// --device: which device works.
#pragma once

#include "harness/commands/cli.h"

#include <string>

namespace sparselens {

// `device`: a word as choose_device() of gpu/device_list.h has it; `list` is answered as --help is. `what_works`, for the help:
// "What warps".
void add_device_option(CLI::App &app, std::string &device, const std::string &what_works);

// As Job::keeps has it: a device, unless the word means none.
inline std::string kept_device(const std::string &word) { return word == "cpu" ? "" : "a device"; }

} // namespace sparselens
