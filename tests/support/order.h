// The order of the samples of a deep picture, asked without the code under test.
#pragma once

#include "deep/ldi.h"

namespace sparselens {

// sorted: z, then z_back, ascend in every pixel. apart: no samples of a pixel overlap, that is, no two points have the
// same depth, no point lies inside a volume (it may lie at an end), and no two volumes have a stretch in common. If a
// depth is NaN, both are false.
struct Order {
    bool sorted = true, apart = true;
};

Order order_of(const Ldi &ldi);

} // namespace sparselens
