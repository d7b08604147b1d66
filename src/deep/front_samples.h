// The front sample of each pixel. The LDI must be sorted.
#pragma once

#include "../lens/thin_lens.h"
#include "../view/view.h"
#include "ldi.h"

#include <limits>
#include <string>
#include <vector>

namespace sparselens {

// The planar depth of the front sample of pixel (x, y), EXR coordinates, or 0 where it has none.
float front_depth(const Ldi &ldi, const Imath::V2i &pixel);

// The same for all pixels, as a single channel Z (float); depth_of_nothing where a pixel is empty.
inline constexpr float depth_of_nothing = std::numeric_limits<float>::infinity();
Image front_depth(const Ldi &ldi);

// Its R, G, B, as far as they are there, and its planar depth, 0 where there is none.
View front_view(const Ldi &ldi, const std::string &name);

// Its signed CoC radius, for each pixel. An empty pixel is background at infinity.
std::vector<float> front_circles_of_confusion(const Ldi &ldi, const ThinLens &lens);

} // namespace sparselens
