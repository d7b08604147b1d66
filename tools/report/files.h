// Whole files as strings.
#pragma once

#include <filesystem>
#include <string>

namespace sparselens {

// Error where it cannot be read.
std::string contents_of_file(const std::filesystem::path &path);

// Makes the folder where it is missing; the file appears whole or not at all.
void write_file(const std::filesystem::path &path, const std::string &contents);

} // namespace sparselens
