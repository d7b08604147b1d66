// The lens through which an LDI is gathered.
#pragma once

#include "dof/methods.h"
#include "harness/tool.h"
#include "io/lens_file.h"
#include "io/open_ldi.h"

#include <optional>

namespace sparselens {

// The lens of the LDI's camera. If `focus_pixel` (EXR coordinates) is given, the lens and the camera are focused on
// what the middle one of its sub-pixels shows, of which there are `across`, across and down; UsageError if it shows nothing. Warns if the aperture is larger than the one of the views.
ThinLens lens_for_ldi(OpenedLdi &in, const std::optional<Imath::V2i> &focus_pixel, int across,
                      const ToolContext &tool);

// The looks of the lens where the method knows any (chain/picture_looks.h). Warns where it does not know what the camera says.
LensLooks looks_for_ldi(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows, const GatherMethod *method, const ToolContext &tool);

} // namespace sparselens
