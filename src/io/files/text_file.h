// Whole files as strings: text, or any other bytes.
// Errors (Error) name the file and the system's reason.
#pragma once

#include <string>
#include <string_view>

namespace sparselens {

// The contents of a file; `-` stands for standard input. Pipes and devices may send 64 MB.
std::string read_text_file(const std::string &path);

// The file appears whole or not at all (see OutputFile). `-` stands for standard output.
void write_text_file(const std::string &path, std::string_view contents);

} // namespace sparselens
