// Rounds the values of an LDI to the precision that a lens picture needs. Files become smaller, because trailing zeros
// compress.
//
//   Z, ZBack, ldi.optical   within 1/64 pixel of CoC
//   ldi.dx, ldi.dy          multiples of 1/64 pixel
//   ldi.weight, ldi.solid   within 1/32 of themselves
//   colours                 within 1/512 of themselves, a step that is finer than the noise of a render
//
// Coverage, data, ids and Cryptomattes stay as they are, and so does the order of the depths of a pixel (tidy.h).
// "Pixels" are the picture's.
#pragma once

#include "ldi.h"

namespace sparselens {

// `scale`: perceptive depth is scale / z, in pixels of the picture (lens/thin_lens.h); 0: depths stay as they
// are.
void round_for_lens(Ldi &ldi, double scale);

} // namespace sparselens
