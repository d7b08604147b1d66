// Files of JSON that others may have written.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace sparselens {

// Throws Error, naming the file, where it cannot be read, is not JSON, or is nested deeper than 32 levels: what works on
// the values calls itself for each of them.
nlohmann::json read_json_file(const std::string &path);

// A value as an error message shows it: of a long one, its beginning.
std::string shown_in_message(const nlohmann::json &value);

} // namespace sparselens
