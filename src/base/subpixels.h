// Makes a picture from sub-pixels.
//
// Light, and the coverage of each Cryptomatte id, is the mean of the sub-pixels, weighted by the pixel's filter
// (base/pixel_filter.h). Ids and data have no mean and come from the sub-pixel in the middle.
#pragma once

#include "image.h"
#include "pixel_filter.h"

namespace sparselens {

// The pixels that contain the sub-pixels of `box` if `across` of them, across and down, become one pixel.
Imath::Box2i reduced(const Imath::Box2i &box, int across);

// The sub-pixels of the pixels of a box.
Imath::Box2i subpixels_in(const Imath::Box2i &box, int across);

// The same, and the sub-pixels around them that the pixel's filter reaches.
Imath::Box2i subpixels_under(const Imath::Box2i &box, const Subpixels &by);

// The sub-pixel in the middle of a pixel; right of and below the middle if their number is even. If the result would
// overflow, it is the outermost coordinate, where no picture is.
Imath::V2i middle_subpixel(const Imath::V2i &pixel, int across);

// The pixels whose filter reaches a sub-pixel of `box`.
Imath::Box2i pixels_reached(const Imath::Box2i &box, const Subpixels &by);

// The pixels `box` of the picture. Sub-pixels that `fine` lacks are empty inside its display window, with data of
// `nothing`. Outside of it they are unknown and are left out of the mean. Sums are in double, so a constant stays
// constant up to float rounding.
Image mean_of_subpixels(const Image &fine, const Subpixels &by, const Imath::Box2i &box, float nothing = 0);

} // namespace sparselens
