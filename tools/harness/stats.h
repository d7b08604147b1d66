// --stats: writes statistics on the work that a stage left out, as one line of JSON per stage and frame, so that the
// stages of a pipe can share a file. docs/stats.md explains the keys.
#pragma once

#include "harness/tool.h"

#include <nlohmann/json.hpp>

namespace sparselens {

using Stats = nlohmann::ordered_json;

// Appends a line with the name of the tool, the frame if there are several, and `fields` to the file that --stats names
// (- for stderr). Does nothing without --stats. Throws Error if the file cannot be written.
void write_stats(const ToolContext &tool, const Stats &fields);

} // namespace sparselens
