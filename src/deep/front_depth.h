// Depth of what each pixel shows first.
#pragma once

#include "ldi.h"

namespace sparselens {

// Planar depth of the front sample of pixel (x, y), EXR coordinates; 0 where there is none. The LDI is sorted.
float front_depth(const Ldi &ldi, const Imath::V2i &pixel);

// The same for all pixels, as the one channel Z (float); infinity where a pixel is empty.
Image front_depth(const Ldi &ldi);

} // namespace sparselens
