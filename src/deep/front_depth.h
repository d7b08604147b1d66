// The depth of the front sample of each pixel.
#pragma once

#include "ldi.h"

namespace sparselens {

// The planar depth of the front sample of pixel (x, y), EXR coordinates, or 0 where it has none. The LDI is sorted.
float front_depth(const Ldi &ldi, const Imath::V2i &pixel);

// The same for all pixels, as a single channel Z (float); infinity where a pixel is empty.
Image front_depth(const Ldi &ldi);

} // namespace sparselens
