#include "chain/layer_notes.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

const char *fate_of(const Channel &channel) {
    if (is_in_matte(channel)) return "Cryptomatte: ids are copied, their coverage goes through the lens";
    if (holds_ids(channel)) return "ids: those of the front sample, never averaged";
    if (is_light(channel)) return "light: goes through the lens";
    return "data: averaged as light is, but no highlight and no colour";
}

struct Layer {
    std::string name;
    const char *fate;
    bool operator==(const Layer &) const = default;
};

Layer layer_of(const Channel &channel) {
    const std::size_t dot = channel.name.rfind('.');
    const bool plain = dot == std::string::npos;
    const std::string name = is_in_matte(channel) ? channel.matte : channel.name.substr(0, plain ? 0 : dot);
    return {plain && !is_light(channel) ? channel.name : name, fate_of(channel)};
}

} // namespace

std::vector<std::string> layer_notes(std::span<const Channel> channels) {
    std::vector<Layer> layers;
    for (const Channel &channel : channels)
        if (Layer layer = layer_of(channel); std::ranges::find(layers, layer) == layers.end())
            layers.push_back(std::move(layer));
    std::vector<std::string> notes;
    for (const Layer &layer : layers)
        notes.push_back(
            fmt::format("layer {}: {}", layer.name.empty() ? "of the picture" : layer.name, layer.fate));
    return notes;
}

} // namespace sparselens
