// Pictures for the screen: PNG (W3C, "Portable Network Graphics Specification", 2nd edition).
#pragma once

#include "base/image.h"

#include <string>

namespace sparselens {

// The bytes of an 8-bit RGB PNG of the image's first three channels, values already as the screen shows them: 0
// becomes 0, 1 becomes 255, what is outside of [0, 1] is cut off, NaN is 0.
std::string png_of(const Image &image);

} // namespace sparselens
