// Whole files as strings: text, or any other bytes.
// Errors (Error) name the file and the system's reason.
#pragma once

#include <string>
#include <string_view>

namespace sparselens {

// The contents of a file of at most 64 MB; `-` stands for standard input.
std::string read_text_file(const std::string &path);

// The same for a file of any size, and of any bytes.
std::string read_bytes(const std::string &path);

// Writes the file; it appears complete or not at all (see OutputFile). `-` stands for standard output.
void write_text_file(const std::string &path, std::string_view contents);

} // namespace sparselens
