// The stereo views ("left", "right", ...) that a file names.
#pragma once

#include <string>
#include <vector>

namespace sparselens {

// The views of all parts, the default view first; empty if the file names none. Reads only the header. Throws Error if
// the file cannot be read.
std::vector<std::string> stereo_views(const std::string &path);

} // namespace sparselens
