// Measures how certain the values of a fitted lens are, and by how much motion blurs the plate.
#pragma once

#include "match/likely_lens.h"

namespace sparselens {

// How each pixel of a lens's picture changes with the CoC at the middle depth, and with the CoC at the ends of the
// range of depths.
struct Slopes {
    Colours by_coc, by_ends;
};

LensFit fit_with(const Comparison &pictures, const KnownLens &known, const LikelyLens &at,
                 const Slopes &slopes);

} // namespace sparselens
