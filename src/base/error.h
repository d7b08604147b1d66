// The two ways in which a job can fail. The tools tell them apart by their exit codes.
#pragma once

#include <stdexcept>
#include <string>

namespace sparselens {

// A failure of input, output or memory: exit code 1. The message names the file, part, channel or parameter.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The command line asks for something impossible, or lacks something needed: exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace sparselens
