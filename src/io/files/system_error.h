// Turns the error of a system call (errno) into an Error.
#pragma once

#include "base/error.h"
#include "io/files/file_stream.h"

#include <cerrno>
#include <cstring>
#include <string>

namespace sparselens {

// Throws Error with the file, the action that failed, and the system's reason.
[[noreturn]] inline void fail_of_system(const std::string &path, const std::string &what) {
    throw Error(display_name(path) + ": " + what + ": " + std::strerror(errno));
}

} // namespace sparselens
