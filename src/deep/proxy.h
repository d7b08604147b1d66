// A small LDI that stands for a large one, for quick previews, and the other way round.
#pragma once

#include "ldi.h"

#include <span>

namespace sparselens {

// What a small LDI is made for.
struct ProxyFor {
    // A lens: samples whose perceptive depths, scale / z in pixels of the large LDI, differ by at most `tolerance` pixels are one
    // surface. 0: none; then those are whose depths differ by at most a hundredth.
    double scale = 0, tolerance = 0;
    std::span<const float> left = {}; // [sample]: by what its light is multiplied; empty: 1
    // [sample]: the first one of its small pixel that shows the same surface, however far its depth is from that one's; empty: as by
    // the tolerance alone. They lie at the mean of their depths.
    std::span<const std::uint32_t> joined = {};
};

// The LDI at 1 / factor of its size, factor >= 1. The depth of a surface is the harmonic mean of those of its samples. Its coverage and
// colours are its share of the mean of the flattened pixels, so that the flattened small LDI is the mean (box filter) of the flattened
// large one; its position is their mean. Samples that they hide completely are kept behind it. Ids are those of the first sample of a
// surface. What is solid behind a surface (Ldi::solid) is the least of its samples', but for a lens the most. Data windows whose size is
// not a multiple of `factor` are filled up with empty pixels. The result has a channel A even if `ldi` has none.
Ldi proxy(const Ldi &ldi, int factor, const ProxyFor &by = {});

// The LDI at `factor` times its size: each pixel as often, across and down. Where in a pixel its samples lie is forgotten.
Ldi enlarged(const Ldi &ldi, int factor);

} // namespace sparselens
