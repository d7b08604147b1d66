// Averages views through a lens that are read from files.
#pragma once

#include "harness/tool.h"
#include "lab/averaging/lens_view_files.h"
#include "view/resolve_lens.h"

namespace sparselens {

// The lens that gives the shift of each view. Shifting needs no aperture, so its radius is 1 and lens points are in
// scene units. If the options give an aperture, views outside of it are removed from `files`. A pinhole has no shift
// and needs no other value. Throws Error if no view is left, and UsageError if the focal length or the focus is
// unknown.
ThinLens stop_down(LensViewFiles &files, const LensValues &options);

// Reads the views one after another and returns their mean. Outside its data window, a view is black and transparent if
// `transparent_outside`; otherwise it is left out of the mean there. Non-finite values are replaced, with a warning.
Image average_views(LensViewFiles &files, const ThinLens &lens, bool transparent_outside,
                    const ToolContext &tool);

} // namespace sparselens
