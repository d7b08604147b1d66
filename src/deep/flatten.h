// A deep picture seen without a lens.
#pragma once

#include "ldi.h"

namespace sparselens {

// Composites the tidy LDI front to back, in file order, by `over`. The picture has all channels of `ldi` over its data
// window, each composited by its own coverage (channel_alpha.h).
Image flatten(const Ldi &ldi);

} // namespace sparselens
