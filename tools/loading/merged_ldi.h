// Several deep pictures of one camera, opened as one.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"

#include <string>
#include <vector>

namespace sparselens {

// Opens the files, of which there is at least one, and merges them (merge_ldis). Warns of invalid values.
OpenedLdi open_merged(const std::vector<std::string> &paths, const OpenOptions &options,
                      const ToolContext &tool);

} // namespace sparselens
