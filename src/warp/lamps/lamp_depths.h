// Corrects the depth of small lamps' pixels where the renderer wrote the depth of what is behind them.
//
// A renderer takes the depth of a pixel on a lamp's edge from one of its samples, which may show the lamp or the wall
// behind. Either way most of its light is the lamp's and must not be seen at the wall's depth. So pixels of a small
// lamp in front of everything around it take the depth of pixels beside them that have the lamp's depth. All pixels of
// a lamp that strands or bars cross take it, if nothing around has that depth. silhouettes.h gives back to the lamp the
// light that has the depth of a strand. If a view has no pixel at the lamp's depth, other views that show as much light
// at that position give the depth. If all views have the wall's depth, the lamp gets the depth at which its positions
// in all views agree, unless the wall's depth explains the positions equally well. Pixels that show little of a lamp
// stay as they are if a pixel beside them shows only the lamp, because silhouettes.h can separate those.
#pragma once

#include "deep/view_samples.h"
#include "view/view_mapping.h"

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

// The pixels of the lamps of a view that strands or bars cross, in ascending order.
using PartlyHiddenLamps = std::vector<std::size_t>;

// Views must have at most one sample per pixel. mappings[v] tells where the centre view shows what views[v] shows.
// Depths whose inverses differ by less than `tolerance`, > 0, are one surface. Returns the crossed lamps of each view.
// The result does not depend on the order of the views.
std::vector<PartlyHiddenLamps> repair_lamp_depths(std::span<ViewSamples> views,
                                                  std::span<const ViewMapping> mappings, double tolerance);

} // namespace sparselens
