// The lens through which an LDI is gathered.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"

#include <optional>

namespace sparselens {

// Of the LDI's camera, focused on what `focus_pixel` (EXR coordinates) shows, if it is given; this
// then becomes the camera's focus. Warns where the lens sees further around things than the views did.
// UsageError: that pixel shows nothing.
ThinLens lens_for_ldi(OpenedLdi &in, const std::optional<Imath::V2i> &focus_pixel, const ToolContext &tool);

} // namespace sparselens
