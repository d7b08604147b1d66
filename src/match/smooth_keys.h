// Makes values that were found frame by frame smooth over the frames, as a focus puller moves.
//
// Minimises sum w (x - value)^2 / deviation^2 + stiffness sum (x[t-1] - 2 x[t] + x[t+1])^2 (Whittaker 1923, Henderson
// 1924). The stiffness is the largest at which the values still lie about one deviation from the result. A value far
// from it counts less (weights of Huber).
#pragma once

#include <span>
#include <vector>

namespace sparselens {

struct KeyedValue {
    double value = 0;
    double deviation = 0; // standard deviation, > 0; infinite: the value is unknown
};

// The result lies at the same frames, evenly spaced. Deviations are those of the result, not larger than before.
// At least one value must be known.
std::vector<KeyedValue> smooth_keys(std::span<const KeyedValue> keys);

} // namespace sparselens
