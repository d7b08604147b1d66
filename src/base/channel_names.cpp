#include "base/channel_names.h"

#include "base/image.h"
#include "base/text.h"

#include <array>
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

} // namespace sparselens
