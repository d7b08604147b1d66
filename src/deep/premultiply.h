// Multiplies colours by their coverage, where a file has them unpremultiplied ("straight").
#pragma once

#include "base/image.h"

#include <span>

namespace sparselens {

// Multiplies every channel of light but coverage: by the A of its layer where that has one, else by the coverage of the channel
// (channel_alpha.h). A channel without coverage stays as it is.
void premultiply(std::span<const Channel> channels, std::span<const std::span<float>> planes);

} // namespace sparselens
