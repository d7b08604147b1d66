// Gives each volume of a deep picture (smoke and fog, whose samples reach from z to z_back) one depth for the gather.
//
// A volume of even density absorbs light by the same share over each distance. Its light therefore comes from depths
// that follow an exponential distribution, which is cut off at the back of the volume. The mean is the middle of thin
// smoke, and nearly the front of dense smoke.
#pragma once

#include "deep/ldi.h"

namespace sparselens {

// The mean of that distribution, as a share of the volume's extent: 0.5 without coverage, 0 for coverage 1.
double shown_depth(double alpha);

// Moves each volume, and its image in a mirror, to its mean depth. The result has no extents. The LDI must be tidy:
// its volumes do not overlap, so samples keep their order. Volumes that never end stay at their front.
Ldi at_shown_depths(Ldi ldi);

} // namespace sparselens
