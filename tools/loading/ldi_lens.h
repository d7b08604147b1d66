// The lens through which an LDI is gathered.
#pragma once

#include "loading/ldi_cache.h"

#include <optional>

namespace sparselens {

// Of the options and the LDI's camera, focused on what `focus_pixel` (EXR coordinates) shows, if it is given; this
// then becomes the camera's focus. Warns where the lens sees further around things than the views did.
// UsageError: that pixel shows nothing.
ThinLens lens_for_ldi(InputLdi &in, const LensOptions &options, const std::optional<Imath::V2i> &focus_pixel,
                      const ToolContext &tool);

} // namespace sparselens
