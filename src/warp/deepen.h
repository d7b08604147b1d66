// A view as an LDI: one sample in each pixel that shows something: A not 0, depth above 0.
#pragma once

#include "deep/ldi.h"
#include "view/view.h"

#include <span>

namespace sparselens {

// With the view's channels of these names, in this order; positions are the pixel centres, weights 1. Throws
// Error, naming the view, where it lacks a channel.
Ldi deepen(const View &view, std::span<const Channel> channels);

} // namespace sparselens
