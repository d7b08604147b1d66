// Makes values that were found frame by frame smooth over the frames, as a focus puller moves.
//
// Minimises sum w (x - value)^2 / deviation^2 + stiffness sum (x[t-1] - 2 x[t] + x[t+1])^2 (Whittaker 1923, Henderson
// 1924). The stiffness is the most likely one (restricted maximum likelihood, as for smoothing splines: Wahba 1985).
// All deviations are multiplied by their most likely factor; the given ones count like a few values. A value far from
// the result hardly counts (weights of Student's t distribution).
#pragma once

#include <span>
#include <vector>

namespace sparselens {

struct KeyedValue {
    double value = 0;
    double deviation = 0; // standard deviation, > 0; infinite: the value is unknown
};

// The result lies at the same frames, evenly spaced. Deviations are those of the result. At least one value must be
// known.
std::vector<KeyedValue> smooth_keys(std::span<const KeyedValue> keys);

} // namespace sparselens
