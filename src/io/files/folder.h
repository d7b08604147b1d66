// Folders for what is written.
#pragma once

#include <string>

namespace sparselens {

// Makes the folder, and those it lies in, where they are missing. Error, naming it, where it cannot be made.
void make_folder(const std::string &path);

} // namespace sparselens
