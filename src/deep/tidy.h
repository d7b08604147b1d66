// A deep picture brought into the state that every stage works on: sorted, and without overlaps.
#pragma once

#include "ldi.h"

namespace sparselens {

// Sorts every pixel by z (then z_back, then the order they stand in), drops samples that show nothing (neither
// coverage nor light), splits and merges overlapping volumes and merges points of one depth by the rules of
// "Interpreting OpenEXR Deep Pixels" (F. Kainz, 2013). Then z ascends strictly: a volume that begins at a point's
// depth begins one ulp behind it, and at infinity lies at most one sample. A volume that overlaps others and
// reaches to infinity has no density that could be split, and becomes a point at its front. What is tidy already is
// handed back as it came.
Ldi tidy(Ldi ldi);

} // namespace sparselens
