// A lens and how well its picture fits the plate.
#pragma once

#include "match/lens_search.h"

namespace sparselens {

struct LikelyLens {
    BlurGuess guess;
    double likelihood = 0;
    Rgb linear, shown; // its picture: as gathered, and as the plate shows it
};

// The picture of the nearest guess that is allowed.
LikelyLens compared(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess);

// The same, with the softness that fits best, which needs no other gathered picture.
LikelyLens softest(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess);

} // namespace sparselens
