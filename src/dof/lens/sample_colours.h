// Colours of the samples of a BlockedSamples, in groups of four channels so that one load brings one group:
// [group][sample][4], premultiplied; channel k of the LDI is entry k % 4 of group k / 4.
#pragma once

#include "base/channel_kind.h"
#include "base/parallel.h"
#include "deep/ldi.h"
#include "dof/lens/sample_blocks.h"
#include "kernels/lens_rules.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// The kind of a channel, for a lens that treats colours differently; one bit each, so that kinds form sets.
enum ColourSet : std::uint8_t {
    red = kernels::is_red,
    green = kernels::is_green,
    blue = kernels::is_blue,
    coverage = kernels::is_coverage,
    data = kernels::is_data,
    all_colours = 31
};
inline bool is_colour(ColourSet set) { return (set & (red | green | blue)) != 0; }

struct SampleColours {
    std::size_t groups = 0, count = 0; // of channels / 4, of samples
    LargeArray<float> values;
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

// `count` >= the number of channels.
inline std::vector<ColourSet> colour_sets(const Ldi &ldi, std::size_t count) {
    std::vector<ColourSet> sets(count, data);
    constexpr std::array of_part{data, red, green, blue, coverage};
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        sets[k] = of_part[std::size_t(colour_part(ldi.channels[k]))];
    return sets;
}

inline SampleColours make_colours(const Ldi &ldi, const BlockedSamples &samples) {
    const std::size_t channels = ldi.channels.size(), groups = (channels + 3) / 4, count = samples.count();
    SampleColours colours{groups, count, LargeArray<float>(groups * count * 4), colour_sets(ldi, groups * 4)};
    parallel_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < groups * 4; ++k) {
                const bool has_value = k < channels && samples.source[i] != BlockedSamples::background;
                colours.at(k, i) = has_value ? ldi.values[k][samples.source[i]] : 0;
            }
    });
    return colours;
}

// Channels that are light, without coverage; and the channels among them that say how bright a sample is.
struct LightChannels {
    std::vector<std::size_t> all, brightness;
};

inline LightChannels light_channels(const Ldi &ldi) {
    LightChannels light;
    for (std::size_t k = 0; k < ldi.channels.size(); ++k) {
        const Channel &channel = ldi.channels[k];
        if (!is_light(channel) || k == ldi.alpha()) continue;
        light.all.push_back(k);
        if (channel.name == "R" || channel.name == "G" || channel.name == "B") light.brightness.push_back(k);
    }
    return light;
}

} // namespace sparselens
