// An LDI with padding around it, and the padding that a lens needs.
#pragma once

#include "../lens/thin_lens.h"
#include "ldi.h"

namespace sparselens {

// The LDI with its data window grown to contain `data`; the new pixels are empty.
Ldi padded(Ldi ldi, const Imath::Box2i &data);

// How far the lens spreads its samples at most, in pixels across and down: the largest |c|, rounded up.
Imath::V2i largest_reach(const Ldi &ldi, const ThinLens &lens);

} // namespace sparselens
