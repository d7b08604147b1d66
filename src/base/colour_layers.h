// Channels of light that are treated together.
#pragma once

#include "base/image.h"

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

// Groups the indices of the channels of light that may be calculated with. R, G and B of one layer form a group, in the
// order of the channels; every other channel, coverage too, is a group of its own.
std::vector<std::vector<std::size_t>> colour_layers(std::span<const Channel> channels);

} // namespace sparselens
