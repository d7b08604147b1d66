// Writes the files of a report, and finds files by pattern.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sparselens::lab {

// Creates the folder if it is missing. The file appears complete or not at all.
void write_file(const std::filesystem::path &path, const std::string &contents);

// The files of a folder whose names match a pattern with one *, in order, with the path of the folder, if any.
std::vector<std::string> matching_files(const std::filesystem::path &pattern);

// The words, with each word that has a * in its last part replaced by the matching files, relative to `folder`.
std::vector<std::string> with_files(const std::vector<std::string> &words, const std::string &folder);

} // namespace sparselens::lab
