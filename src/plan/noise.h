// The noise of a rendered picture, and how much of it a lens leaves.
//
// Two things distinguish noise from texture. Its second differences are as large along every direction, while those of
// texture are small along its edges. And they are Gaussian (the quartile and the median of their magnitudes are in the
// ratio 0.3186 to 0.6745), while those of edges are sparse. Blocks of pixels that are not Gaussian count as free of
// noise, and so do blocks with few Gaussian ones around: aliased texture is Gaussian in some blocks by chance.
#pragma once

#include "base/image.h"
#include "lens/thin_lens.h"

#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// Mean square, tone-mapped (base/tone_map.h), of the noise that is left of each pixel in the lens picture of a view:
// where the CoC has radius c > 1, noise is averaged over its disc of pi c^2 pixels. It is measured in blocks of 8 x 8
// pixels and the blocks around them, from R, G and B of the image; z: planar depth per pixel. `deviation`: the standard
// deviation of the noise, tone-mapped, if known instead of measured.
std::vector<double> noise_in_lens_picture(const Image &image, std::span<const float> z, const ThinLens &lens,
                                          std::optional<double> deviation = {});

} // namespace sparselens
