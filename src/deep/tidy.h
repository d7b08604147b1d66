// Brings the samples of a deep picture into the order that every stage expects: sorted and without overlaps.
#pragma once

#include "ldi.h"

namespace sparselens {

// Sorts every pixel by z (then by z_back, then by the order in the file), drops samples with neither coverage nor
// light, splits and merges overlapping volumes, and merges points of equal depth by the rules of "Interpreting OpenEXR
// Deep Pixels" (F. Kainz, 2013). Then z ascends strictly: a volume that begins at the depth of a point begins one ulp
// behind it, and at most one sample lies at infinity. A volume that overlaps others and reaches to infinity has no
// density that could be split, and becomes a point at its front. An LDI that is already tidy is returned unchanged.
Ldi tidy(Ldi ldi);

} // namespace sparselens
