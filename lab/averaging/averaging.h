// Averages the views of a lens, which are read from files.
#pragma once

#include "harness/tool.h"
#include "lab/averaging/lens_view_files.h"
#include "view/resolve_lens.h"

namespace sparselens {

// The lens by which the views are shifted. Shifting needs no aperture, so its radius is 1 and lens points are in scene
// units. If the options give an aperture, the views outside of it are removed from `files`. A pinhole shifts nothing
// and needs no other value. Throws Error if no view is left, and UsageError if the focal length or the focus is
// unknown.
ThinLens stop_down(LensViewFiles &files, const LensValues &options);

// Reads the views one after another and returns their mean. Outside its data window, a view is black and transparent if
// `transparent_outside`; otherwise it does not count there. Values that are not finite are replaced, with a warning.
Image average_views(LensViewFiles &files, const ThinLens &lens, bool transparent_outside,
                    const ToolContext &tool);

} // namespace sparselens
