// What was done to a picture, in its metadata, by the names that OpenImageIO uses: the attribute Exif:ImageHistory
// gets one line more, the command; Software says by what that was done.
#pragma once

#include "harness/tool.h"

#include <CLI/CLI.hpp>
#include <ImfHeader.h>

#include <string>
#include <vector>

namespace sparselens {

// The command line as a shell reads it, in one line. Left out is what does not change the picture: where it is written,
// threads, memory, messages and which other frames are made. So the same work gives the same bytes.
std::string command_line(const std::string &tool, const std::vector<std::string> &words);

struct HistoryOptions {
    bool none = false;
};
void add_history_option(CLI::App &app, HistoryOptions &options);

// Appends tool.command_line.
void append_history(Imf::Header &header, const ToolContext &tool, const HistoryOptions &options = {});

} // namespace sparselens
