// Views of a lens, from files, averaged.
#pragma once

#include "harness/tool.h"
#include "loading/lens_view_files.h"
#include "view/resolve_lens.h"

namespace sparselens {

// The lens that moves the views; its radius is 1, so that lens points are in scene units: moving needs no aperture.
// Where the options ask for one, views outside of it are left out; a pinhole moves nothing and needs nothing else.
// Error: no view stands within the aperture. UsageError: the focal length or the focus is unknown.
ThinLens stop_down(LensViewFiles &files, const LensValues &options);

// Reads one view after the other. What lies outside a view's data window is black if `transparent_outside`, else the
// view does not count there. Values that are not finite are filled, with a warning.
Image average_views(LensViewFiles &files, const ThinLens &lens, bool transparent_outside,
                    const ToolContext &tool);

} // namespace sparselens
