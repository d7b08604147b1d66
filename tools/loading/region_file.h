// The regions of a picture (measure/regions.h), found from an LDI.
#pragma once

#include "harness/tool.h"
#include "io/open_options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sparselens {

// The RegionBit set of each pixel of the data window of `target`, from the front samples of the file, which is deep or
// flat with depth. Throws Error, naming the file, if its display window has another size, and UsageError if a lens
// value is neither in the options nor in the file.
std::vector<std::uint8_t> regions_over(const Windows &target, const std::string &file,
                                       const OpenOptions &options, const ToolContext &tool);

} // namespace sparselens
