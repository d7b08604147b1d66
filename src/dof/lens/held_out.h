// What holds the picture out, and what its lookups need to be told.
#pragma once

#include "deep/holdout.h"

#include <Imath/ImathVec.h>

#include <limits>

namespace sparselens {

struct HeldOut {
    const Holdout *by = nullptr;
    double depth_at_1 = 1;   // perceptive depth at z = 1
    Imath::V2i corner{0, 0}; // of the data window that the samples are relative to, EXR coordinates

    // The share of light from that perceptive depth that passes at a pixel, relative to `corner`; `by` is given.
    float passes(const Imath::V2i &pixel, float depth) const {
        const double z = depth > 0 ? depth_at_1 / double(depth) : std::numeric_limits<double>::infinity();
        return float(by->passes(corner.x + pixel.x, corner.y + pixel.y, z));
    }
};

} // namespace sparselens
