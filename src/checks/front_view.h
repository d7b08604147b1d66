// An LDI of one sample a pixel at most, as a view again.
#pragma once

#include "../deep/ldi.h"
#include "../view/view.h"

#include <string>

namespace sparselens {

// The front sample of each pixel: its R, G, B, as far as they are there, and its planar depth, 0 where there is none.
View front_view(const Ldi &ldi, const std::string &name);

} // namespace sparselens
