#include "base/channel_names.h"

#include "base/image.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <string>
#include <unordered_set>

namespace sparselens {

std::string colour_name(std::string_view name) {
    struct Colour {
        std::string_view letter, word;
    };
    static constexpr std::array<Colour, 4> colours{
        {{"r", "red"}, {"g", "green"}, {"b", "blue"}, {"a", "alpha"}}};
    const std::size_t layer = name.rfind('.') + 1; // 0: no layer
    const std::string last = lower_case(std::string(name.substr(layer)));
    for (const auto &[letter, word] : colours)
        if (last == letter || last == word)
            return std::string(name.substr(0, layer)) + upper_case(std::string(letter));
    return std::string(name);
}

std::vector<std::string> names_of_colours(std::span<const Channel> channels) {
    std::unordered_set<std::string> taken;
    for (const Channel &channel : channels) taken.insert(channel.name);
    std::vector<std::string> names;
    for (const Channel &channel : channels) {
        std::string name = is_light(channel) ? colour_name(channel.name) : channel.name;
        names.push_back(taken.insert(name).second ? std::move(name) : channel.name);
    }
    return names;
}

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
