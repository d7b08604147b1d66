// Means of rays over similar pixels nearby (non-local means: A. Buades, B. Coll, J. Morel, 2005). The guide decides
// which pixels are similar, so the means are linear in the rays. They follow edges of any form that the guide shows.
#pragma once

#include "base/grid.h"
#include "finish/colours.h"

namespace sparselens {

// The means for both renders. `guide` and the renders have the same channels.
Halves means_of_similar(const Halves &rays, const Colours &guide, const Grid &grid);

} // namespace sparselens
