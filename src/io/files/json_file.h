// JSON files, which others may have written.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace sparselens {

// Throws Error, naming the file, if it cannot be read, is not JSON, or is nested deeper than 32 levels, because code
// that works on the values is recursive.
nlohmann::json read_json_file(const std::string &path);

// A value as an error message shows it: a long one is cut off.
std::string shown_in_message(const nlohmann::json &value);

} // namespace sparselens
