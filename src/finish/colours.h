// The planes that dof-finish works on: the channels of one layer, treated together.
#pragma once

#include "base/large_array.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sparselens {

using Values = LargeArray<float>;      // one for each pixel
using Colours = std::vector<Values>;   // one to three channels
using Halves = std::array<Colours, 2>; // the same of two independent renders

// max(v, 0), exactly, without the branch that keeps compilers from treating several values at once.
inline float positive(float v) { return (v + std::abs(v)) / 2; }

// How much a change of a value is seen where it is as bright as `v`: the squared slope of the tone curve v / (1 + v).
inline float seen(float v) {
    const float reciprocal = 1 / (1 + positive(v));
    return reciprocal * reciprocal * reciprocal * reciprocal;
}

// How bright a pixel is: the mean of its channels, at least 0.
inline float brightness(const Colours &colours, std::size_t i) {
    float sum = 0;
    for (const Values &channel : colours) sum += channel[i];
    return std::max(sum / float(colours.size()), 0.0f);
}

} // namespace sparselens
