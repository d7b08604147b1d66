// False-colour pictures that show how the gather treats an LDI.
//
// The windows are those of the LDI; R, G and B are display values in [0, 1], and A is 1. The colours depend only on the
// pixel, never on the rest of the picture, so that frames can be compared.
#pragma once

#include "../base/image.h"
#include "../deep/ldi.h"
#include "../lens/thin_lens.h"
#include "lens/lens_gather.h"

namespace sparselens {

// The CoC c of the front sample of each pixel: white in focus, blue in front of it, red behind it, and half of the way
// at |c| = 8 pixels. An empty pixel is sky.
Image coc_colours(const Ldi &ldi, const ThinLens &lens);

// The flattened picture in dark grey, with the brightness tone-mapped by v / (1 + v); green where the front sample is
// in focus, |c| < 1 pixel.
Image focus_colours(const Ldi &ldi, const ThinLens &lens);

// Samples per pixel: 0 black, 1 grey, 2 blue, 3 cyan, 4 green, 5 yellow, 6 orange, 7 red, more white.
Image layer_colours(const Ldi &ldi);

// Lens points per tile: none (copied) is black; others are coloured by their logarithm, from blue (16) through green to
// red (4096). `windows`: those of the picture that the tiles divide.
Image tile_colours(const LensTiles &tiles, const Windows &windows);

} // namespace sparselens
