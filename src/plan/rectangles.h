// A few rectangles that contain all pixels of a mask, because renderers crop by rectangles.
#pragma once

#include "disocclusion.h"

namespace sparselens {

// At most `most` rectangles, which may overlap; none for an empty mask. EXR coordinates, corners included.
std::vector<Imath::Box2i> rectangles_over(const PixelMask &mask, std::size_t most = 64);

} // namespace sparselens
