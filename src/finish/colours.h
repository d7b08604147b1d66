// The planes that dof-finish works on: the channels of one layer, treated together.
#pragma once

#include "base/large_array.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sparselens {

using Values = LargeArray<float>;      // one value per pixel
using Colours = std::vector<Values>;   // one to three channels
using Halves = std::array<Colours, 2>; // the same for two independent renders

// max(v, 0), exactly, without a branch, so that compilers can process several values at once.
inline float positive(float v) { return (v + std::abs(v)) / 2; }

// How visible a change is in a value as bright as `v`: the squared slope of the tone curve v / (1 + v).
inline float seen(float v) {
    const float reciprocal = 1 / (1 + positive(v));
    return reciprocal * reciprocal * reciprocal * reciprocal;
}

// The brightness of a pixel: the mean of its channels, at least 0.
inline float brightness(const Colours &colours, std::size_t i) {
    float sum = 0;
    for (const Values &channel : colours) sum += channel[i];
    return std::max(sum / float(colours.size()), 0.0f);
}

} // namespace sparselens
