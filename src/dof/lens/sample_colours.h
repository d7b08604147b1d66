// Colours of the samples of a BlockedSamples, in groups of four channels so that one load brings one group:
// [group][sample][4], premultiplied; channel k of the LDI is entry k % 4 of group k / 4.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

struct SampleColours {
    std::size_t groups = 0, count = 0; // of channels / 4, of samples
    std::vector<float> values;

    std::span<const float> group(std::size_t g) const {
        return std::span(values).subspan(g * count * 4, count * 4);
    }
    float &at(std::size_t channel, std::size_t sample) {
        return values[(channel / 4 * count + sample) * 4 + channel % 4];
    }
    float at(std::size_t channel, std::size_t sample) const {
        return values[(channel / 4 * count + sample) * 4 + channel % 4];
    }
};

} // namespace sparselens
