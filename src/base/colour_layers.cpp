#include "base/colour_layers.h"

#include <algorithm>
#include <string>

namespace sparselens {

namespace {

std::string prefix_of(const std::string &name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? "" : name.substr(0, dot + 1);
}

} // namespace

std::vector<std::vector<std::size_t>> colour_layers(std::span<const Channel> channels) {
    std::vector<std::vector<std::size_t>> layers;
    std::vector<std::string> prefixes; // of layers of colours; for other channels, a name that no layer has
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (!is_light(channels[c]) || channels[c].type == PixelType::uint32) continue;
        const ColourPart part = colour_part(channels[c]);
        const bool colour = part != ColourPart::none && part != ColourPart::coverage;
        const std::string prefix = colour ? prefix_of(channels[c].name) : channels[c].name + "/";
        const auto found = std::ranges::find(prefixes, prefix);
        if (found == prefixes.end()) {
            prefixes.push_back(prefix);
            layers.push_back({c});
        } else {
            layers[std::size_t(found - prefixes.begin())].push_back(c);
        }
    }
    return layers;
}

} // namespace sparselens
