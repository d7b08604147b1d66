// Defines a lamp: light that is so much brighter than its surroundings that its disc shows, where other samples out of focus blur
// into each other. All searches for lamps use these thresholds, and differ only in the surroundings:
// - highlights, which are spread exactly (dof/lens/highlights.h): the samples of the windows that it lies in;
// - what the border of the frame cuts off (dof/lens/beyond/border.h): the samples beside it along the border;
// - whether light beyond the frame would show (dof/border_reach.h): nearly all samples of the border;
// - the lamps of a view (warp/lamps/compact_lamps.h): the pixels of its block, and its brightest pixel stands out twice as far;
// - light between strands (warp/mixed/wisps.h): the strands.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace sparselens {

struct LampTuning {
    // Times the surroundings.
    static constexpr float stands_out = 4;
    // The same of the brightest pixel of a lamp by which views are compared.
    static constexpr float stands_out_of_view = 8;
    // One in this number of samples may be a lamp's, and the others surround it; ...
    static constexpr std::size_t one_in = 5;
    // ... along the whole border.
    static constexpr std::size_t one_in_border = 32;
};

template <typename Light>
bool stands_out(Light brightness, Light surroundings, float times = LampTuning::stands_out) {
    return brightness > Light(times) * surroundings;
}

// What all samples but one in so many stay below; of none: 0. Changes their order.
inline float surroundings_of(std::span<float> brightness, std::size_t one_in) {
    if (brightness.empty()) return 0;
    const auto level = brightness.end() - 1 - std::ptrdiff_t(brightness.size() / one_in);
    std::nth_element(brightness.begin(), level, brightness.end());
    return *level;
}

} // namespace sparselens
