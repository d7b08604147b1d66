// Several deep pictures of one camera as one.
#pragma once

#include "../io/open_ldi.h"

#include <vector>

namespace sparselens {

// Merges the samples of the pictures, which are not empty, by depth (deep/merge.h). Name, header and camera are those of
// the first. Throws Error, naming the file, if its display window, its sub-pixels or its focal length differ from those of the first.
OpenedLdi merge_ldis(std::vector<OpenedLdi> parts);

} // namespace sparselens
