// A view as an LDI, with one sample in each pixel that shows something (A is not 0, depth is above 0).
#pragma once

#include "deep/ldi.h"
#include "view/view.h"

#include <span>

namespace sparselens {

// The LDI has the channels of these names, in this order. Positions are the pixel centres and weights are 1. Throws
// Error, naming the view, where it lacks a channel.
Ldi deepen(const View &view, std::span<const Channel> channels);

} // namespace sparselens
