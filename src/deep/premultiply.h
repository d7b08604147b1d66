// Multiplies colours by their coverage, where a file has them unpremultiplied ("straight").
#pragma once

#include "base/image.h"

#include <span>

namespace sparselens {

// Of every channel of light that is no coverage: by the A of its layer where that has one, else by what covers it
// (channel_alpha.h). Where nothing covers it, it stays.
void premultiply(std::span<const Channel> channels, std::span<const std::span<float>> planes);

} // namespace sparselens
