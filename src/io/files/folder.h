// Folders for output.
#pragma once

#include <string>

namespace sparselens {

// Creates the folder and its parents where they are missing. Throws Error, naming it, where that fails.
void make_folder(const std::string &path);

} // namespace sparselens
