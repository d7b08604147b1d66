// How the samples of a deep picture are ordered, in the sense of the attribute deepImageState of OpenEXR.
#pragma once

#include "ldi.h"

namespace sparselens {

// sorted: z, then z_back, ascend in every pixel. apart: no samples of a pixel overlap, that is, no two points have the
// same depth, no point lies inside a volume (it may lie at an end), and no two volumes have a stretch in common. These
// are SORTED and NON_OVERLAPPING of ImfDeepImageState.h of OpenEXR; both together are TIDY. If a depth is NaN, both are
// false.
struct Order {
    bool sorted = true, apart = true;
};

Order order_of(const Ldi &ldi);

} // namespace sparselens
