// The brightness of a picture as the eye sees it.
#pragma once

#include "base/image.h"

#include <vector>

namespace sparselens {

// For each pixel the mean of the tone-mapped colours that the image has, [0, 1) (base/tone_map.h).
std::vector<double> brightness(const Image &image);

} // namespace sparselens
