// The browser of the desktop.
#pragma once

#include <string>

namespace sparselens {

// Opens the page through a file that its owner alone can read, as every user of the machine sees the words of a command.
// Throws Error where the file cannot be written or nothing opens it.
void open_browser(const std::string &address);

} // namespace sparselens
