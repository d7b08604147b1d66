// An LDI with padding around it, and the pixels that a lens spreads it over.
#pragma once

#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "ldi.h"

namespace sparselens {

// The LDI with its data window grown to contain `data`; the new pixels are empty.
Ldi padded(Ldi ldi, const Imath::Box2i &data);

// The pixels of the display window over which a lens of these looks spreads samples, each as far as its own light
// reaches (lens/light_reach.h); a reach of less than half a pixel does not count. Empty if there are no such pixels.
Imath::Box2i reached_display(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks = {});

} // namespace sparselens
