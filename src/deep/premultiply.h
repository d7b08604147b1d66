// Multiplies colours by their coverage, if a file has them unpremultiplied ("straight").
#pragma once

#include "base/image.h"

#include <span>

namespace sparselens {

// Multiplies every channel of light except coverage, by the A of its layer if the layer has one, otherwise by the
// channel's coverage (channel_alpha.h). A channel without coverage stays as it is.
void premultiply(std::span<const Channel> channels, std::span<const std::span<float>> planes);

} // namespace sparselens
