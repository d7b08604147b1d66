// Several deep pictures of one camera, opened as one.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"

#include <string>
#include <vector>

namespace sparselens {

// Opens the files, which are not empty, and merges their samples by depth (deep/merge.h). Header and camera are those of
// the first file. Warns of invalid values. Throws Error, naming the file, if its display window or its focal length
// differs from that of the first.
OpenedLdi open_merged(const std::vector<std::string> &paths, const OpenOptions &options,
                      const ToolContext &tool);

} // namespace sparselens
