// Pictures, in false colours, of what the gather makes of an LDI.
//
// Windows are the LDI's; R, G, B in [0, 1] as a screen shows them, A is 1. The colours depend on the pixel
// alone, never on the rest of the picture, so that frames can be compared.
#pragma once

#include "../base/image.h"
#include "../deep/ldi.h"
#include "../lens/thin_lens.h"
#include "lens/lens_tiles.h"

namespace sparselens {

// CoC c of what each pixel shows first: white in focus, blue in front of it, red behind, half of the way at
// |c| = 8 pixels. An empty pixel is sky.
Image coc_colours(const Ldi &ldi, const ThinLens &lens);

// The flattened picture in dark grey, brightness tone-mapped, v / (1 + v); green where what shows first is in
// focus, |c| < 1 pixel.
Image focus_colours(const Ldi &ldi, const ThinLens &lens);

// Samples a pixel: 0 black, 1 grey, 2 blue, 3 cyan, 4 green, 5 yellow, 6 orange, 7 red, more white.
Image layer_colours(const Ldi &ldi);

// Lens points a tile: none (copied) black, else from blue (16) by green to red (4096), by their logarithm.
// `windows`: of the picture that the tiles divide.
Image tile_colours(const LensTiles &tiles, const Windows &windows);

} // namespace sparselens
