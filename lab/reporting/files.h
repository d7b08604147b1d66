// Files that a report writes, and files by pattern.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sparselens::lab {

// Creates the folder if it is missing. The output is atomic.
void write_file(const std::filesystem::path &path, const std::string &contents);

// The files of a folder whose names match a pattern with one *, in order, with the path of the folder, if any.
std::vector<std::string> matching_files(const std::filesystem::path &pattern);

// The words, where each word with a * in its last part is replaced by the files that match, relative to `folder`.
std::vector<std::string> with_files(const std::vector<std::string> &words, const std::string &folder);

} // namespace sparselens::lab
