// The two ways a job can fail, told apart by the tools' exit codes.
#pragma once

#include <stdexcept>
#include <string>

namespace sparselens {

// Input, output or memory: exit 1. Messages name what they are about: file, part, channel or parameter.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The command line asks for what cannot be done, or leaves out what is needed: exit 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace sparselens
