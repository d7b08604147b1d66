// The depth of small lamps' pixels, where the renderer wrote that of what is behind them.
//
// A renderer takes the depth of a pixel on a lamp's edge from one of its samples, which may be of the lamp or of the wall
// behind. Either way most of its light is the lamp's, and would be seen at the depth of the wall. So pixels of a small lamp
// that stands before all that is around it take the depth of those beside them that have the lamp's. So do those of a lamp that
// strands or bars cross: nothing around has its depth. What of its light has the depth of a strand, silhouettes.h gives back to it.
// Where a view has no pixel at the lamp's depth, other views tell, which show as much light at that place. Where all views have the
// wall's depth, the places tell at which all of them show the lamp, unless it may as well be on the wall. Pixels that show little of
// a lamp stay as they are, if a pixel beside them shows nothing else than the lamp: silhouettes.h can take those apart.
#pragma once

#include "deep/view_samples.h"
#include "view/view_mapping.h"

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

// Pixels of a view, in ascending order: those of the lamps that strands or bars cross.
using CrossedLamps = std::vector<std::size_t>;

// Views have at most one sample a pixel; mappings[v] tells where the centre view shows what views[v] shows. Depths whose
// inverses differ by less than `tolerance`, > 0, are one surface. Returns the crossed lamps of each view. The result does not depend
// on the order of the views.
std::vector<CrossedLamps> settle_lamp_depths(std::span<ViewSamples> views,
                                             std::span<const ViewMapping> mappings, double tolerance);

} // namespace sparselens
