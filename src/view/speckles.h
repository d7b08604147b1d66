// Finds speckles: pixels amid a surface that have the depth of the sky.
//
// Where a renderer scatters a ray, in fog, it may write the depth of the sky: pixels of one surface then have, at
// random, the surface's depth or 1e10. Such a pixel takes the depth of the pixels around it if it is opaque, at least
// five of the eight pixels around it are nearer by 16 times or more, and its colour matches theirs, within a quarter
// plus their own differences. This is repeated until no pixel changes, because speckles come in clumps.
//
// Sky that is really seen through a small hole has the colour of the sky, and stays. A picture with hardly any
// speckles, or with more holes and gaps in hair, is left alone: among the pixels that stand alone (seven of the eight
// around them are nearer), one in four must have the colour of those around it, and these must have one depth.
#pragma once

#include "../base/image.h"
#include "view.h"

#include <cstddef>
#include <span>
#include <string>

namespace sparselens {

// Replaces the depths of speckles and returns how many. Depths must be above 0 up to inf, colours premultiplied, and
// all values valid (deep/sanitize.h). `planes`: the channels, one value per pixel.
std::size_t settle_speckles(const Windows &windows, std::span<const Channel> channels,
                            std::span<const std::span<const float>> planes, std::span<float> z);
std::size_t settle_speckles(View &view);

// The warning about replaced depths.
std::string speckle_warning(std::size_t settled);

} // namespace sparselens
