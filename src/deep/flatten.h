// A deep picture seen without a lens, and the front sample of each of its pixels. The LDI must be sorted.
#pragma once

#include "../lens/thin_lens.h"
#include "../view/view.h"
#include "ldi.h"

#include <limits>
#include <string>
#include <vector>

namespace sparselens {

// Composites the tidy LDI front to back, in file order, by `over`. The picture has all channels of `ldi` over its data
// window, each composited by its own coverage (channel_alpha.h).
Image flatten(const Ldi &ldi);

// The planar depth of the front sample of pixel (x, y), EXR coordinates; 0 if the pixel has no sample.
float front_depth(const Ldi &ldi, const Imath::V2i &pixel);

// The same for all pixels, as a single channel Z (float); depth_of_nothing where a pixel is empty.
inline constexpr float depth_of_nothing = std::numeric_limits<float>::infinity();
Image front_depth(const Ldi &ldi);

// R, G, B and A of the front sample, as far as the LDI has them, and its planar depth; 0 if there is no sample.
View front_view(const Ldi &ldi, const std::string &name);

// The signed CoC radius of the front sample, for each pixel. An empty pixel is background at infinity.
std::vector<float> front_circles_of_confusion(const Ldi &ldi, const ThinLens &lens);

} // namespace sparselens
