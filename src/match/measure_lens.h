// What a plate says about a lens that fits it: how certain it is, and how the plate is blurred by motion.
#pragma once

#include "match/likely_lens.h"

namespace sparselens {

// How the picture of a lens changes, per pixel: with the CoC at the middle depth, and with that at the ends of the range
// of depths.
struct Slopes {
    Colours by_coc, by_ends;
};

LensFit fit_with(const Comparison &pictures, const KnownLens &known, const LikelyLens &at,
                 const Slopes &slopes);

} // namespace sparselens
