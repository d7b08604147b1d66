// Records the history of a picture in its metadata, under the names that OpenImageIO uses: the command is appended as a
// line to the attribute Exif:ImageHistory, and Software names the program. Tells by it whether a picture is up to date.
#pragma once

#include "harness/commands/cli.h"
#include "harness/commands/named_files.h"
#include "harness/tool.h"

#include <ImfHeader.h>

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// The command line in shell syntax, in one line, without the options that do not change the picture: the output,
// threads, memory, messages and the other frames. So the same work gives the same bytes.
std::string command_line(const std::string &tool, const std::vector<std::string> &words);

struct HistoryOptions {
    bool none = false;
};
void add_history_option(CLI::App &app, HistoryOptions &options);

// Whether the parsed options ask for the command line to be recorded.
bool records_history(const CLI::App &parsed);

// The last line of the history of an EXR file; empty if it has none or the file is not an EXR file. Throws a
// std::exception if its header cannot be read.
std::optional<std::string> last_command(const std::string &path);

// Appends tool.command_line.
void append_history(Imf::Header &header, const ToolContext &tool, const HistoryOptions &options = {});

// Whether a frame needs no work (-u).
enum class Freshness {
    stale, // work is needed
    fresh, // every output exists, is complete, is not older than any input, and was made by this command
    not_compared, // the same, but the command that made it is unknown: an output has no history, or none was asked for
};

// `command_line` is the frame's and begins with the name of the tool; empty: it is not compared.
Freshness freshness_of(const NamedFiles &files, const std::string &command_line);

} // namespace sparselens
