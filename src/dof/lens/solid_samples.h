// The solids behind samples (Ldi::solid), as lens points see them: each such sample once more, farther away by its
// solid.
//
// A lens point that sees something behind a solid sees the solid instead: light finds no way through a gap as narrow as
// what no view saw through. This holds for things at least as far behind the solid as the solid lies behind its sample.
// Cracks and fillers come first: they decide where a lens point meets nothing opaque.
//
// A solid shows the colour of its sample. If the sample covers less than its pixel, as on edges, the solid shows the
// opaque sample of this pixel or one of the eight around it that is nearest in 1 / z and does not lie behind the solid;
// without such a sample there is no solid. Mirrors and glass, which show images, are not solid.
#pragma once

#include "deep/ldi.h"
#include "dof/lens/sample_blocks.h"
#include "lens/thin_lens.h"

namespace sparselens {

// Returns the solids of an LDI, in the blocks of its `samples`, before looks move them (optics.h); no blocks if nothing
// is solid. Their CoC says where solids are seen. Their depth is the depth from which on they hide what is farther.
// Their key has that depth, and names the one of `samples` that shows.
BlockedSamples place_solids(const Ldi &ldi, const ThinLens &lens, const BlockedSamples &samples);

} // namespace sparselens
