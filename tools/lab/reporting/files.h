// Whole files as strings, and files by pattern.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sparselens::lab {

// Error where it cannot be read.
std::string contents_of_file(const std::filesystem::path &path);

// Makes the folder where it is missing; the file appears whole or not at all.
void write_file(const std::filesystem::path &path, const std::string &contents);

// The files of a folder whose names match a pattern with one *, in order; the folder's path, if any, in front.
std::vector<std::string> matching_files(const std::filesystem::path &pattern);

// Each word whose last part holds a * replaced by the files that match, relative to `folder` as the word is.
std::vector<std::string> with_files(const std::vector<std::string> &words, const std::string &folder);

} // namespace sparselens::lab
