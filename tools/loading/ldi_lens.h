// The lens through which an LDI is gathered.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"

#include <optional>

namespace sparselens {

// The lens of the LDI's camera. If `focus_pixel` (EXR coordinates) is given, the lens and the camera are focused on
// what that pixel shows; UsageError if it shows nothing. Warns if the aperture is larger than the one of the views.
ThinLens lens_for_ldi(OpenedLdi &in, const std::optional<Imath::V2i> &focus_pixel, const ToolContext &tool);

} // namespace sparselens
