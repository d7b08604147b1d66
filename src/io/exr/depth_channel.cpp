#include "io/exr/depth_channel.h"

#include "base/channel_names.h"
#include "base/error.h"
#include "base/text.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

namespace sparselens {

namespace {

std::string what_there_is(const std::vector<Channel> &channels) {
    std::vector<std::string> names;
    for (const Channel &channel : channels) names.push_back(channel.name);
    return names.empty() ? "it has no channels" : "its channels are " + first_of(names);
}

std::size_t named(std::span<const Channel> channels, const std::string &asked) {
    if (const std::size_t exactly = find_channel(channels, asked); exactly != npos) return exactly;
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (lower_case(channels[k].name) == lower_case(asked)) return k;
    return npos;
}

// The first of the channels with the clearest name.
std::size_t by_rank(std::span<const Channel> channels) {
    std::size_t best = npos;
    int least = 0;
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (const auto rank = depth_rank(channels[k].name); rank && (best == npos || *rank < least)) {
            best = k;
            least = *rank;
        }
    return best;
}

// The only channel for which `is` holds; npos if there are none or several.
template <typename Is>
std::size_t only(std::span<const Channel> channels, const Is &is) {
    std::size_t found = npos;
    for (std::size_t k = 0; k < channels.size(); ++k) {
        if (channels[k].type == PixelType::uint32 || is_in_matte(channels[k]) ||
            !is(lower_case(channels[k].name)))
            continue;
        if (found != npos) return npos;
        found = k;
    }
    return found;
}

std::size_t guessed(std::span<const Channel> channels) {
    const auto is_alone = [&](const std::string &name) {
        return name.ends_with(".z") && named(channels, name.substr(0, name.size() - 1) + "x") == npos;
    };
    if (const std::size_t k = only(channels, is_alone); k != npos) return k;
    return only(channels, [](const std::string &name) { return name.find("depth") != name.npos; });
}

} // namespace

std::optional<int> depth_rank(std::string_view name) {
    static constexpr std::array layers{"z", "depth", "zdepth"};
    const std::string lower = lower_case(std::string(name));
    if (lower == "z") return 0;
    if (lower == "depth.z") return 1;
    if (lower.ends_with(".depth.z")) return 2;
    if (lower.ends_with(".zback") || lower.ends_with("depthback")) return {};
    const std::size_t dot = lower.find('.');
    if (dot != lower.rfind('.') || !is_among(layers, lower.substr(0, dot))) return {};
    const std::string last = dot == lower.npos ? "" : lower.substr(dot + 1);
    if (colour_name(last) == "A") return {}; // belongs to a depth that was written as a picture
    return colour_name(last) == "G" || colour_name(last) == "B" ? 4 : 3;
}

DepthChannel find_depth_channel(const std::vector<Channel> &channels, const std::string &asked,
                                const std::string &path) {
    const std::size_t clear = asked.empty() ? by_rank(channels) : named(channels, asked);
    const std::size_t k = clear == npos && asked.empty() ? guessed(channels) : clear;
    if (k == npos)
        throw Error(
            asked.empty()
                ? fmt::format("{}: has no depth channel (Z, depth.Z, *.Depth.Z and the like): give "
                              "`depth_file` where it is in a file of its own, else `depth_channel`; {}",
                              display_name(path), what_there_is(channels))
                : fmt::format("{}: has no channel {} (`depth_channel`); {}", display_name(path), asked,
                              what_there_is(channels)));
    const std::string &name = channels[k].name;
    if (channels[k].type == PixelType::uint32)
        throw Error(
            fmt::format("{}: the depth channel {} holds integers, not depths", display_name(path), name));
    if (clear != npos) return {name};
    return {name, fmt::format("channel {} is taken for the depth; if it is not, give `depth_channel`", name)};
}

bool has_depth_channel(const std::vector<Channel> &channels, const std::string &asked) {
    return (asked.empty() ? by_rank(channels) : named(channels, asked)) != npos;
}

namespace {

// The depth channel. A file that holds only depth may give it any name: Y, or a grey R, G and B.
DepthChannel depth_of(const std::vector<Channel> &channels, const std::string &asked,
                      const std::string &path) {
    if (asked.empty() && !has_depth_channel(channels, asked)) {
        const std::size_t red = find_channel(channels, "R");
        if (channels.size() == 1 || red != npos)
            return find_depth_channel(channels, channels[channels.size() == 1 ? 0 : red].name, path);
    }
    return find_depth_channel(channels, asked, path);
}

// Adds the plane Z to the picture, all 0.
std::span<float> new_depth(Image &image) {
    std::size_t k = find_channel(image.channels, "Z");
    if (k == npos) {
        k = image.channels.size();
        image.channels.push_back({"Z", PixelType::float32, ChannelKind::data});
        image.values.resize(image.channels.size() * image.windows.pixels());
    }
    const std::span<float> plane = image.plane(k);
    std::ranges::fill(plane, 0.0f);
    return plane;
}

} // namespace

void put_depth_of_file(FlatFile &picture, const std::string &path, const PictureChoice &choice) {
    const std::string &name = choice.depth_file;
    const bool stereo = !choice.stereo_view.empty() && !stereo_views(name).empty();
    const FlatFile file = read_flat_exr(name, {.stereo_view = stereo ? choice.stereo_view : std::string()});
    const Windows &from = file.image.windows, &to = picture.image.windows;
    if (from.display != to.display || from.pixel_aspect != to.pixel_aspect)
        throw Error(
            fmt::format("{}: its display window or its pixel aspect ratio is not that of {}, whose depth "
                        "it is to hold (`depth_file`)",
                        display_name(name), display_name(path)));
    const DepthChannel depth = depth_of(file.image.channels, choice.depth, name);
    const auto values = file.image.plane(find_channel(file.image.channels, depth.name));
    const std::span<float> plane = new_depth(picture.image);
    const Imath::Box2i both(
        {std::max(from.data.min.x, to.data.min.x), std::max(from.data.min.y, to.data.min.y)},
        {std::min(from.data.max.x, to.data.max.x), std::min(from.data.max.y, to.data.max.y)});
    for (int y = both.min.y; y <= both.max.y; ++y)
        for (int x = both.min.x; x <= both.max.x; ++x) plane[to.index(x, y)] = values[from.index(x, y)];
    picture.notes.push_back(fmt::format("depth: {} of {}", depth.name, display_name(name)));
    if (depth.warning) picture.warnings.push_back(display_name(name) + ": " + *depth.warning);
}

} // namespace sparselens
