// Pixels on the edges of a photograph, whose depth was estimated, as two layers.
//
// The edge of a depth lies up to some pixels beside that of the picture, and either may be soft. So depth does not tell
// which pixels near a jump show what. Their colour does: c = a F + (1 - a) B, with F and B, the mean colours of the nearer and
// the farther surface where no jump is near. A pixel with 0 < a < 1 becomes two samples, c - (1 - a) B of coverage a in
// front, and B behind; others become one of the nearer or the farther surface. They stay as they are where colours do not
// tell: where F and B are alike or unknown, and where c is not between them.
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

namespace sparselens {

// The photograph has one sample in each pixel, else it is returned as it is, as if it has A. The result has A.
Ldi matte_edges(Ldi photograph, const ThinLens &lens);

} // namespace sparselens
