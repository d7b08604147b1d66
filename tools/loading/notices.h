// What the tools say of the files they read and write.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"

#include <string>

namespace sparselens {

// What the reader of a file noted with --verbose, and its warnings always.
void say_reading(const ToolContext &tool, const std::string &path, const std::vector<std::string> &notes,
                 const std::vector<std::string> &warnings);

// The same of an LDI; with --verbose also whether coverage is coloured.
void say_samples(const ToolContext &tool, const OpenedLdi &in);

// With --verbose: what the file says about its camera, and which attribute says so.
void say_camera(const ToolContext &tool, const std::string &path, const Camera &camera);

// Each one line on stderr, where there were any; `clamped` is what write_flat_exr and write_ldi return.
void warn_of_clamped(const ToolContext &tool, const std::string &path, std::size_t clamped);
void warn_of_invalid_values(const ToolContext &tool, const std::string &path, const InvalidValues &bad);

} // namespace sparselens
