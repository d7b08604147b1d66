#include "deep/premultiply.h"

#include "base/parallel.h"
#include "deep/channel_alpha.h"

#include <string>

namespace sparselens {

namespace {

std::size_t coverage_for(std::span<const Channel> channels, std::size_t k) {
    const std::string &name = channels[k].name;
    const std::size_t own = find_channel(channels, name.substr(0, name.rfind('.') + 1) + "A");
    return own != npos ? own : coverage_of(channels, k);
}

} // namespace

void premultiply(std::span<const Channel> channels, std::span<const std::span<float>> planes) {
    for (std::size_t k = 0; k < channels.size(); ++k) {
        if (!is_light(channels[k]) || colour_part(channels[k]) == ColourPart::coverage) continue;
        const std::size_t by = coverage_for(channels, k);
        if (by == npos || by == k || coverage_of(channels, k) == k) continue;
        parallel_ranges(planes[k].size(), 65536, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) planes[k][i] *= planes[by][i];
        });
    }
}

} // namespace sparselens
