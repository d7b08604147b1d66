// As mean_of_subpixels(), pixel by pixel and sub-pixel by sub-pixel.
#pragma once

#include "base/subpixels.h"

namespace sparselens {

Image mean_of_subpixels_slowly(const Image &fine, const Subpixels &by, const Imath::Box2i &box);

} // namespace sparselens
