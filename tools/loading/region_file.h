// The regions of a picture (measure/regions.h) as an LDI tells them.
#pragma once

#include "harness/tool.h"
#include "io/open_options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sparselens {

// RegionBit set of each pixel of `target`'s data window, by the front samples of the file: deep, or flat with depth.
// Error, naming it: its display window is of another size. UsageError: a lens value that is nowhere to be found.
std::vector<std::uint8_t> regions_over(const Windows &target, const std::string &file,
                                       const OpenOptions &options, const ToolContext &tool);

} // namespace sparselens
