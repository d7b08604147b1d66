// The lens through which an LDI is gathered.
#pragma once

#include "dof/methods.h"
#include "harness/tool.h"
#include "io/lens_file.h"
#include "io/open_ldi.h"
#include "view/resolve_looks.h"

#include <optional>

namespace sparselens {

// The lens of the LDI's camera. If `focus_pixel` (EXR coordinates) is given, the lens and the camera are focused on
// what that pixel shows; UsageError if it shows nothing. Warns if the aperture is larger than the one of the views.
ThinLens lens_for_ldi(OpenedLdi &in, const std::optional<Imath::V2i> &focus_pixel, const ToolContext &tool);

// The looks of that lens in a picture of these windows: what was given, else what the LDI's camera says, which then becomes the camera's; the lens's name goes into the header. Warns where the
// method does not know what the camera says.
LensLooks looks_for_ldi(OpenedLdi &in, const LensFile &given, const ThinLens &lens, const Windows &windows,
                        const GatherMethod *method, const ToolContext &tool);

} // namespace sparselens
