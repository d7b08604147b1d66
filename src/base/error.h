// The two ways in which a job can fail. The tools tell them apart by their exit codes.
//
// A message of the library, be it an error or a warning, carries each parameter that a user may give between backquotes, by a name
// that belongs to nobody: `lens_radius`, or `depth=inverse` where it says which value to give. spelled() (text.h) makes of it
// what a face of the library calls it: --lens-radius and --depth inverse, lens_radius and depth='inverse'.
#pragma once

#include <stdexcept>
#include <string>

namespace sparselens {

// A failure of input, output or memory: exit code 1. The message names the file, part, channel or parameter.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// What is asked for is impossible, or something needed is missing: exit code 2. The message carries the parameter.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace sparselens
