// A pixel of a view that mixes two surfaces: c = a F + (1 - a) B, where F is what the nearer one shows and B what the
// farther one does.
#pragma once

#include "deep/build.h"

#include <optional>
#include <vector>

namespace sparselens {

struct Mixture {
    double near_depth, far_depth; // perceptive
    double share;                 // a, of the nearer surface; 0: all of the pixel belongs to the farther one
    std::vector<Term> behind; // B; the coefficients sum to 1. The nearer surface shows the rest of the pixel
    std::optional<std::uint64_t> front = {}; // F, one sample; then the farther surface shows the rest
};

} // namespace sparselens
