// An LDI with padding around it, and the pixels that a lens spreads it over.
#pragma once

#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "ldi.h"

namespace sparselens {

// The LDI with its data window grown to contain `data`; the new pixels are empty.
Ldi padded(Ldi ldi, const Imath::Box2i &data);

// The pixels of the display window that a lens of these looks spreads samples over, each as far as its own light reaches
// (lens/light_reach.h), from half a pixel on. Empty where there are none.
Imath::Box2i reached_display(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks = {});

} // namespace sparselens
