// How orderly the samples of a deep picture are, as the attribute deepImageState of OpenEXR means it.
#pragma once

#include "ldi.h"

namespace sparselens {

// sorted: in every pixel z, then z_back, ascend. apart: in no pixel do samples overlap: no two points at one
// depth, no point inside a volume (at its ends it may lie), no two volumes with a common stretch. Definitions:
// ImfDeepImageState.h of OpenEXR, SORTED and NON_OVERLAPPING; both are TIDY. Depths that are no numbers are
// neither.
struct Order {
    bool sorted = true, apart = true;
};

Order order_of(const Ldi &ldi);

} // namespace sparselens
