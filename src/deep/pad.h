// An LDI with room around it, and how much room a lens needs.
#pragma once

#include "../lens/thin_lens.h"
#include "ldi.h"

namespace sparselens {

// The LDI with its data window grown to hold `data`; the new pixels are empty.
Ldi padded(Ldi ldi, const Imath::Box2i &data);

// How far the lens spreads its samples at most, pixels: the largest |c|, rounded up, across and down.
Imath::V2i largest_reach(const Ldi &ldi, const ThinLens &lens);

} // namespace sparselens
