// The messages of the tools about the files that they read and write.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"

#include <span>
#include <string>

namespace sparselens {

struct LensLooks;

// Prints the notes of the reader of a file with --verbose, and its warnings always.
void say_reading(const ToolContext &tool, const std::string &path, const std::vector<std::string> &notes,
                 const std::vector<std::string> &warnings);

// With --verbose: what happens to each layer, a line each.
void say_layers(const ToolContext &tool, const std::string &path, std::span<const Channel> channels);

// The same as say_reading() and say_layers() for an LDI; with --verbose also whether it has per-channel alpha.
void say_samples(const ToolContext &tool, const OpenedLdi &in);

// One line on stderr for each.
void warn_of(const ToolContext &tool, const std::vector<std::string> &warnings);

// What picture_warnings() says of a flat picture; of a deep one, nothing.
void warn_of_flat_picture(const ToolContext &tool, const OpenedLdi &in);

// With --verbose: how much overscan the blur needs, and how much there is, in pixels of `across` sub-pixels; a warning if there is
// too little, and light stands at the border whose disc would be cut.
void say_border_reach(const ToolContext &tool, const std::string &path, const Ldi &ldi, const ThinLens &lens,
                      int across, const LensLooks &looks);

// With --verbose: what the file says about its camera, and which attribute says so.
void say_camera(const ToolContext &tool, const std::string &path, const Camera &camera);

// Each prints one line on stderr if there is anything to report. `clamped` is the result of write_flat_exr or
// write_ldi.
void warn_of_clamped(const ToolContext &tool, const std::string &path, std::size_t clamped);
void warn_of_invalid_values(const ToolContext &tool, const std::string &path, const InvalidValues &bad);

} // namespace sparselens
