// What is solid behind samples (Ldi::solid), as lens points see it: each such sample once more, so much farther away.
//
// A lens point that sees something behind what is solid sees the solid instead: light finds no way through a gap that is as
// narrow as what no view saw through. That holds from as far behind as the solid lies behind its sample. Cracks and fillers
// come first: where a lens point meets nothing opaque, it is left to them.
//
// A solid shows the colour of its sample. Where that covers less than its pixel, as on edges, it is that of the opaque sample
// of the pixel, or of one of the eight around, that is nearest in 1 / z and does not lie behind the solid; without one there is
// no solid. Mirrors and glass, which show images, are not solid.
#pragma once

#include "deep/ldi.h"
#include "dof/lens/sample_blocks.h"
#include "lens/thin_lens.h"

namespace sparselens {

// The solids of an LDI, in the blocks of its `samples`, before looks move them (optics.h); no blocks where nothing is
// solid. Their CoC is where solids are seen, their depth that from which on they hide what is farther; the key has that
// depth, and of `samples` the one that shows.
BlockedSamples place_solids(const Ldi &ldi, const ThinLens &lens, const BlockedSamples &samples);

} // namespace sparselens
