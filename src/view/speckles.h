// Depths of nothing amid a surface.
//
// Where a renderer scatters a ray, in fog, it may write the depth of the sky: pixels of one surface then have, at random, its depth
// or 1e10. Such a pixel takes the depth of those around it. It is opaque; at least five of the eight pixels around it are nearer by
// 16 times or more, and its colour is theirs, within a quarter and what they differ by themselves. That is asked again until no
// pixel changes, as speckles stand in clumps.
//
// A sky that is truly seen through a small hole has the colour of the sky, and stays. So does all in a picture that has hardly any
// speckles, or more holes and gaps of hair: of the pixels that stand alone, seven of eight around them nearer, one of four has to have
// the colour of these, and these one depth.
#pragma once

#include "../base/image.h"
#include "view.h"

#include <cstddef>
#include <span>
#include <string>

namespace sparselens {

// How many depths were replaced. Depths are above 0 up to inf; colours are premultiplied, and all values valid
// (deep/sanitize.h). `planes`: of the channels, one value a pixel.
std::size_t settle_speckles(const Windows &windows, std::span<const Channel> channels,
                            std::span<const std::span<const float>> planes, std::span<float> z);
std::size_t settle_speckles(View &view);

// What is said of it.
std::string speckle_warning(std::size_t settled);

} // namespace sparselens
