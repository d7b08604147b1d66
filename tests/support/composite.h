// What an observer sees through the samples of a pixel, computed slowly from first principles: the emission and
// absorption of overlapping volumes and points, integrated stretch by stretch in long double. Checks tidy and flatten,
// and shares no code with them.
#pragma once

#include "support/ldi_samples.h"

namespace sparselens {

struct Composite {
    long double colour = 0, alpha = 0;
};

// Samples in any order, with z_back filled in. Alpha below 1.
Composite composite(const TestPixel &samples);

// `over` in the given order; any alpha.
Composite composite_in_order(const TestPixel &samples);

} // namespace sparselens
