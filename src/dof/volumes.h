// Where the gather places the volumes of a deep picture: smoke and fog whose samples reach from z to z_back.
//
// The gather knows one depth for each sample. A volume of even density shows its light at depths that follow an
// exponential distribution, which ends at the back of the volume: thin smoke shows its middle, dense smoke its front.
#pragma once

#include "../deep/ldi.h"

namespace sparselens {

// The mean of that distribution, as a share of the volume's extent: 0.5 without coverage, 0 for coverage 1.
double shown_depth(double alpha);

// Each volume as one depth: the result has no extents. Samples keep their order, because volumes do not overlap in a
// tidy LDI. Volumes without end and those of LDIs without alpha stay at their front.
Ldi at_shown_depths(Ldi ldi);

} // namespace sparselens
