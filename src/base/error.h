// The two ways in which a job can fail. The tools tell them apart by their exit codes.
//
// Errors and warnings of the library name parameters between backquotes, in a neutral spelling: `lens_radius`, or
// `depth=inverse` to suggest a value. spelled() (text.h) translates them for the user: --lens-radius and --depth
// inverse for the tools, lens_radius and depth='inverse' for Python.
#pragma once

#include <stdexcept>
#include <string>

namespace sparselens {

// A failure of input, output or memory: exit code 1. The message names the file, part, channel or parameter.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The request is impossible, or a value is missing: exit code 2. The message names the parameter.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace sparselens
