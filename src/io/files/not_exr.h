// What to say of a file that is not EXR.
#pragma once

#include <string>
#include <string_view>

namespace sparselens {

// By its first 8 bytes or more: which of the usual formats of pictures it has, and what to do; "not an EXR file" of all
// others.
std::string not_exr(std::string_view first_bytes);

} // namespace sparselens
