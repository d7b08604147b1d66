// Folders for output.
#pragma once

#include <string>

namespace sparselens {

// Creates the folder and its missing parents. Throws Error, naming it, if that fails.
void make_folder(const std::string &path);

} // namespace sparselens
