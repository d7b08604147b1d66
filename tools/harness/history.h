// Records the history of a picture in its metadata, under the names that OpenImageIO uses: the command is appended as a
// line to the attribute Exif:ImageHistory, and Software names the program.
#pragma once

#include "harness/commands/cli.h"
#include "harness/tool.h"

#include <ImfHeader.h>

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

// Appends tool.command_line.
void append_history(Imf::Header &header, const ToolContext &tool, const HistoryOptions &options = {});

} // namespace sparselens
