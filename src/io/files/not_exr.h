// The error message for a file that is not an EXR file.
#pragma once

#include <string>
#include <string_view>

namespace sparselens {

// Judges by its first 8 bytes or more: names the usual picture format that the file has, and what to do; otherwise "not
// an EXR file".
std::string not_exr(std::string_view first_bytes);

} // namespace sparselens
