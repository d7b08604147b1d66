// The holdout of the picture, and what looking up in it needs.
#pragma once

#include "deep/holdout.h"

#include <Imath/ImathVec.h>

#include <limits>

namespace sparselens {

struct HeldOut {
    const Holdout *by = nullptr;
    double depth_at_1 = 1;   // perceptive depth at z = 1
    Imath::V2i corner{0, 0}; // of the data window that the samples are relative to, EXR coordinates

    // Returns the share of light from a perceptive depth that passes the holdout at a pixel, which is relative to
    // `corner`. `by` must be set.
    float passes(const Imath::V2i &pixel, float depth) const {
        const double z = depth > 0 ? depth_at_1 / double(depth) : std::numeric_limits<double>::infinity();
        return float(by->passes(corner.x + pixel.x, corner.y + pixel.y, z));
    }
};

} // namespace sparselens
