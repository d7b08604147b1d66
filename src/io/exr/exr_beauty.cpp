#include "io/exr/exr_beauty.h"

#include "base/text.h"
#include "io/exr/exr_common.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace sparselens {

namespace {

constexpr std::array names{"rgba", "rgb", "c", "ci", "beauty", "combined", "main", "default"};

bool has_light(const std::vector<Channel> &channels, const std::string &name) {
    const std::size_t k = find_channel(channels, name);
    return k != npos && !holds_ids(channels[k]);
}

bool has_plain_colour(const std::vector<Channel> &channels) {
    return std::ranges::any_of(rgb_names,
                               [&](const char *name) { return find_channel(channels, name) != npos; });
}

// In the order of their channels.
std::vector<std::string> colour_layers(const std::vector<Channel> &channels) {
    std::vector<std::string> layers;
    for (const Channel &channel : channels) {
        if (!channel.name.ends_with(".R")) continue;
        const std::string layer = channel.name.substr(0, channel.name.size() - 2);
        const bool complete = std::ranges::all_of(
            rgb_names, [&](const char *name) { return has_light(channels, layer + "." + name); });
        if (complete) layers.push_back(layer);
    }
    return layers;
}

bool has_depth_beside(const std::string &layer, const std::vector<Channel> &channels) {
    const std::size_t dot = layer.rfind('.');
    return dot != std::string::npos && has_light(channels, layer.substr(0, dot) + ".Depth.Z");
}

std::string in_file(const std::vector<FileChannel> &channels, const std::vector<std::string> &wanted) {
    std::vector<std::string> found;
    for (const std::string &name : wanted)
        for (const FileChannel &channel : channels)
            if (channel.channel.name == name) found.push_back(channel.in_file);
    return found.empty() ? "none" : fmt::format("{}", fmt::join(found, ", "));
}

} // namespace

bool is_beauty_name(std::string_view name) {
    return is_among(names, lower_case(std::string(name.substr(name.rfind('.') + 1))));
}

std::string beauty_names() { return fmt::format("{}", fmt::join(names, ", ")); }

std::string beauty_layer(const std::vector<Channel> &channels) {
    if (has_plain_colour(channels)) return {};
    std::vector<std::string> layers = colour_layers(channels);
    std::erase_if(layers, [](const std::string &layer) { return !is_beauty_name(layer); });
    if (layers.empty()) return {};
    const auto with_depth = std::ranges::find_if(
        layers, [&](const std::string &layer) { return has_depth_beside(layer, channels); });
    return with_depth == layers.end() ? layers.front() : *with_depth;
}

std::vector<std::string> layers_without_beauty(const std::vector<Channel> &channels) {
    if (has_plain_colour(channels) || !beauty_layer(channels).empty()) return {};
    return colour_layers(channels);
}

void name_beauty(std::vector<FileChannel> &channels, const std::string &layer,
                 const std::vector<Channel> &channels_of_picture) {
    for (FileChannel &found : channels)
        for (const char *name : {"R", "G", "B", "A", "AR", "AG", "AB"})
            if (found.channel.name == layer + "." + name && find_channel(channels_of_picture, name) == npos)
                found.channel.name = name;
    colours_first(channels);
}

std::string beauty_note(const std::vector<FileChannel> &channels, const std::string &part) {
    const bool has_alpha =
        std::ranges::any_of(channels, [](const FileChannel &channel) { return channel.channel.name == "A"; });
    return fmt::format("beauty: {}; coverage: {}{}", in_file(channels, {"R", "G", "B"}),
                       has_alpha ? in_file(channels, {"A"}) : in_file(channels, {"AR", "AG", "AB"}),
                       part.empty() ? "" : " (part " + part + ")");
}

std::vector<std::string> beauty_warnings(const std::vector<Channel> &channels) {
    const std::vector<std::string> layers = layers_without_beauty(channels);
    if (layers.empty()) return {};
    return {fmt::format(
        "no layer is named as the beauty ({}), so that the picture has no R, G and B; its layers are {}: "
        "rename the channels of one to R, G, B and A",
        beauty_names(), first_of(layers))};
}

} // namespace sparselens
