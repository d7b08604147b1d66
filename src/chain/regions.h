// The regions of a picture (measure/regions.h), found from an LDI.
#pragma once

#include "chain/notices.h"
#include "io/open_ldi.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sparselens {

// The RegionBit set of each pixel of the data window of `target`, from the front samples of the LDI. Throws Error,
// naming it, if its display window has another size and its pixels are not sub-pixels; UsageError if a value of the
// lens is unknown.
std::vector<std::uint8_t> regions_over(const Windows &target, const OpenedLdi &in, const LensValues &lens,
                                       const Notify &notify);

// The same from a file, either deep or flat with depth.
std::vector<std::uint8_t> regions_over(const Windows &target, const std::string &file,
                                       const OpenOptions &options, const Notify &notify);

} // namespace sparselens
