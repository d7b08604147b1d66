// A deep picture seen without a lens.
#pragma once

#include "ldi.h"

namespace sparselens {

// Composites the tidy LDI front to back, in file order, by `over`: all channels of `ldi` over its data window, each by
// its own coverage (channel_alpha.h).
Image flatten(const Ldi &ldi);

} // namespace sparselens
