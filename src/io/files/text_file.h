// Whole files as strings, which are text or any other bytes, or as JSON. Errors (Error) name the file and the system's
// reason.
#pragma once

#include "base/system/system.h"
#include "io/files/file_stream.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace sparselens {

// The contents of a file of at most 64 MB; `-` stands for standard input.
std::string read_text_file(const std::string &path);

// The same for a file of any size, and of any bytes.
std::string read_bytes(const std::string &path);

// Writes the file; it appears complete or not at all (see OutputFile). `-` stands for standard output.
void write_text_file(const std::string &path, std::string_view contents);

// A JSON file, which others may have written. Throws Error if it is not JSON, or is nested deeper than 32 levels,
// because code that works on the values is recursive.
nlohmann::json read_json_file(const std::string &path);

// A value as an error message shows it: a long one is cut off.
std::string shown_in_message(const nlohmann::json &value);

// A file for code that writes or reads files only by name, in memory where the system can.
class MemoryFile {
public:
    explicit MemoryFile(std::string_view contents = {}); // throws Error if the system provides none

    // Whether it could have so many bytes. If not (errno tells why), what was written may be cut off.
    bool can_hold(std::size_t bytes) const;

    const std::string &path() const { return file_.path(); }

private:
    system::UnnamedFile file_;
};

} // namespace sparselens
