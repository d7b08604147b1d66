// A deep picture seen without a lens.
#pragma once

#include "ldi.h"

namespace sparselens {

// The tidy LDI composited front to back in file order: `over`, all channels of `ldi`, its data window, each by its
// own coverage (channel_alpha.h).
Image flatten(const Ldi &ldi);

} // namespace sparselens
