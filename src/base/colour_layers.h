// Channels of light that are treated together.
#pragma once

#include "base/image.h"

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

// The channels of light that may be calculated with, by index: R, G and B of one layer together, in the order of the channels;
// each other one, coverage too, alone.
std::vector<std::vector<std::size_t>> colour_layers(std::span<const Channel> channels);

} // namespace sparselens
