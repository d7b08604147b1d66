// The highlights that a plate clips, because a sensor and a file have a largest value. Their discs say little about the
// lens: a bright lamp fills each pixel that its edge touches.
#pragma once

#include "match/colours.h"

#include <cstdint>
#include <vector>

namespace sparselens {

// [pixel], 1: a channel of the plate is clipped.
std::vector<std::uint8_t> clipped_pixels(const Colours &plate);

} // namespace sparselens
