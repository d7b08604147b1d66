// The order of the samples of a deep picture, and how it is brought into the one that every stage expects: sorted and
// without overlaps.
#pragma once

#include "ldi.h"

namespace sparselens {

// Sorts every pixel by z (then by z_back, then by the order in the file), drops samples with neither coverage nor
// light, splits and merges overlapping volumes, and merges points of equal depth by the rules of "Interpreting OpenEXR
// Deep Pixels" (F. Kainz, 2013). Then z ascends strictly: a volume that begins at the depth of a point begins one ulp
// behind it, and at most one sample lies at infinity. A volume that overlaps others and reaches to infinity has no
// density that could be split, and becomes a point at its front. An LDI that is already tidy is returned unchanged.
Ldi tidy(Ldi ldi);

// sorted: z, then z_back, ascend in every pixel. apart: no samples of a pixel overlap, that is, no two points have the
// same depth, no point lies inside a volume (it may lie at an end), and no two volumes have a stretch in common. These
// are SORTED and NON_OVERLAPPING of ImfDeepImageState.h of OpenEXR; both together are TIDY. If a depth is NaN, both are
// false.
struct Order {
    bool sorted = true, apart = true;
};

Order order_of(const Ldi &ldi);

} // namespace sparselens
