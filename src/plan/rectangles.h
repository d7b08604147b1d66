// Few rectangles that hold all that a mask asks for: renderers crop by rectangles.
#pragma once

#include "disocclusion.h"

namespace sparselens {

// What a rectangle costs besides its pixels, in pixels: two are joined where that wastes less.
inline constexpr double rectangle_overhead = 256;

// At most `most` of them, which may overlap; none where nothing is set. EXR coordinates, corners included.
std::vector<Imath::Box2i> rectangles_over(const PixelMask &mask, std::size_t most = 64);

} // namespace sparselens
