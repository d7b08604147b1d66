// The picture that a picture of sub-pixels is for.
//
// Light is the mean of the sub-pixels, weighted by the pixel's filter (base/pixel_filter.h), and so is the coverage of each id of a
// Cryptomatte. Ids and data, which have no mean, are those of the sub-pixel in the middle.
#pragma once

#include "image.h"
#include "pixel_filter.h"

namespace sparselens {

// The pixels that contain those of `box` when `across` of these, across and down, become one.
Imath::Box2i reduced(const Imath::Box2i &box, int across);

// The sub-pixels of the pixels of a box.
Imath::Box2i subpixels_in(const Imath::Box2i &box, int across);

// The same, and those beside them that the pixel's filter reaches.
Imath::Box2i subpixels_under(const Imath::Box2i &box, const Subpixels &by);

// Where the sub-pixel in the middle of a pixel is; right of and below the middle, if their number is even. A pixel so far out that its
// sub-pixels cannot be counted has the outermost one that can, where no picture is.
Imath::V2i middle_subpixel(const Imath::V2i &pixel, int across);

// The pixels whose filter reaches a sub-pixel of `box`.
Imath::Box2i pixels_reached(const Imath::Box2i &box, const Subpixels &by);

// The pixels `box` of the picture. Sub-pixels that `fine` lacks are empty in its display window, where data are `nothing`; beyond it,
// where nobody knows what they show, they count as those that are known. Floats are added up in double, so what is constant stays so
// to within their rounding.
Image mean_of_subpixels(const Image &fine, const Subpixels &by, const Imath::Box2i &box, float nothing = 0);

} // namespace sparselens
