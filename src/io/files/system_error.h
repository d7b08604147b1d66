// What a system call leaves in errno, as an Error.
#pragma once

#include "base/error.h"
#include "io/files/file_stream.h"

#include <cerrno>
#include <cstring>
#include <string>

namespace sparselens {

// Throws Error: the file, what could not be done with it, and the reason of the system.
[[noreturn]] inline void fail_of_system(const std::string &path, const std::string &what) {
    throw Error(display_name(path) + ": " + what + ": " + std::strerror(errno));
}

} // namespace sparselens
