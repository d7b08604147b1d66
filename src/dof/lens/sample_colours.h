// Colours of the samples of a BlockedSamples, in groups of four channels so that one load brings one group:
// [group][sample][4], premultiplied; channel k of the LDI is entry k % 4 of group k / 4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// What a channel is to a lens that treats colours differently; one bit each, so that they make sets.
enum ColourSet : std::uint8_t { red = 1, green = 2, blue = 4, coverage = 8, data = 16, all_colours = 31 };

struct SampleColours {
    std::size_t groups = 0, count = 0; // of channels / 4, of samples
    std::vector<float> values;
    std::vector<ColourSet> sets = {}; // [channel], of all groups; the channels that fill up the last are data

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
