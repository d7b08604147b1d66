#include "io/exr/exr_channels.h"

#include "base/channel_kind.h"
#include "base/error.h"
#include "base/text.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>

namespace sparselens {

namespace {

constexpr std::array beauty_words{"rgba", "rgb", "c", "ci", "beauty", "combined", "main", "default"};

std::string in_file(const std::vector<FileChannel> &channels, const std::vector<std::string> &wanted) {
    std::vector<std::string> found;
    for (const std::string &name : wanted)
        for (const FileChannel &channel : channels)
            if (channel.channel.name == name) found.push_back(channel.in_file);
    return found.empty() ? "none" : fmt::format("{}", fmt::join(found, ", "));
}

constexpr std::array colours{"R", "G", "B", "A", "AR", "AG", "AB"};

// Names of channels that hold no ids.
using Names = std::set<std::string>;

Names names_with_light(const std::vector<Channel> &channels) {
    Names found;
    for (const Channel &channel : channels)
        if (!holds_ids(channel)) found.insert(channel.name);
    return found;
}

// "fg." for "fg.Combined"; empty if there is no dot.
std::string prefix_of(const std::string &layer) { return layer.substr(0, layer.rfind('.') + 1); }

// The depth of a picture in a layer; empty if it has none.
std::string own_depth(const PictureLayer &picture, const Names &channels) {
    if (picture.prefix.empty()) return {};
    for (const std::string &wanted :
         {picture.prefix + "depth.z", picture.prefix + "z", picture.beauty + ".z"})
        for (const std::string &name : channels)
            if (lower_case(name) == lower_case(wanted)) return name;
    return {};
}

// The first beauty of each layer.
std::vector<PictureLayer> with_beauty(const std::vector<Channel> &channels) {
    std::vector<PictureLayer> pictures;
    Names found;
    for (const std::string &layer : colour_layers(channels)) {
        if (!is_beauty_name(layer)) continue;
        const std::string prefix = prefix_of(layer);
        if (!found.insert(prefix).second) continue;
        pictures.push_back({prefix.empty() ? layer : prefix.substr(0, prefix.size() - 1), layer, prefix});
    }
    return pictures;
}

std::optional<PictureLayer> picture_named(const std::string &name, const std::vector<Channel> &channels) {
    for (const PictureLayer &picture : with_beauty(channels))
        if (name == picture.name || name == picture.beauty) return picture;
    if (!is_among(colour_layers(channels), name)) return {};
    return PictureLayer{name, name, name + "."};
}

std::vector<std::string> names_of(const std::vector<PictureLayer> &pictures,
                                  std::string PictureLayer::*name) {
    std::vector<std::string> names;
    for (const PictureLayer &picture : pictures) names.push_back(picture.*name);
    return names;
}

} // namespace

bool is_beauty_name(std::string_view name) {
    return is_among(beauty_words, lower_case(std::string(name.substr(name.rfind('.') + 1))));
}

std::string beauty_names() { return fmt::format("{}", fmt::join(beauty_words, ", ")); }

bool has_plain_colour(const std::vector<Channel> &channels) {
    return std::ranges::any_of(rgb_names,
                               [&](const char *name) { return find_channel(channels, name) != npos; });
}

std::vector<std::string> colour_layers(const std::vector<Channel> &channels) {
    const Names with_light = names_with_light(channels);
    std::vector<std::string> layers;
    for (const Channel &channel : channels) {
        if (!channel.name.ends_with(".R")) continue;
        const std::string layer = channel.name.substr(0, channel.name.size() - 2);
        const bool complete = std::ranges::all_of(
            rgb_names, [&](const char *name) { return with_light.contains(layer + "." + name); });
        if (complete) layers.push_back(layer);
    }
    return layers;
}

std::vector<std::string> layers_without_beauty(const std::vector<Channel> &channels) {
    if (has_plain_colour(channels)) return {};
    std::vector<std::string> layers = colour_layers(channels);
    const auto is_beauty = [](const std::string &layer) { return is_beauty_name(layer); };
    return std::ranges::any_of(layers, is_beauty) ? std::vector<std::string>() : layers;
}

void name_beauty(std::vector<FileChannel> &channels, const std::string &layer,
                 const std::vector<Channel> &channels_of_picture) {
    for (FileChannel &found : channels)
        for (const char *name : {"R", "G", "B", "A", "AR", "AG", "AB"})
            if (found.channel.name == layer + "." + name && find_channel(channels_of_picture, name) == npos)
                rename(found, name);
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
        "give `layer` with the one that is the picture",
        beauty_names(), first_of(layers))};
}

std::vector<PictureLayer> pictures_in(const std::vector<Channel> &channels) {
    if (has_plain_colour(channels)) return {};
    std::vector<PictureLayer> pictures = with_beauty(channels);
    const Names names = names_with_light(channels);
    const auto lacks_depth = [&](const PictureLayer &p) { return own_depth(p, names).empty(); };
    if (!std::ranges::all_of(pictures, lacks_depth)) std::erase_if(pictures, lacks_depth);
    return pictures;
}

std::optional<PictureLayer> chosen_picture(const std::vector<Channel> &channels, const std::string &asked,
                                           const std::string &path) {
    if (asked.empty()) {
        const std::vector<PictureLayer> pictures = pictures_in(channels);
        if (pictures.size() > 1)
            throw UsageError(fmt::format("{}: holds several pictures, {}: give `layer` with one of {}",
                                         display_name(path),
                                         fmt::join(names_of(pictures, &PictureLayer::beauty), " and "),
                                         fmt::join(names_of(pictures, &PictureLayer::name), ", ")));
        return {};
    }
    if (auto picture = picture_named(asked, channels)) return picture;
    std::vector<std::string> names = names_of(with_beauty(channels), &PictureLayer::name);
    if (names.empty()) names = colour_layers(channels);
    throw Error(fmt::format("{}: has no layer '{}' with R, G and B (`layer`): {}", display_name(path), asked,
                            names.empty() ? "it has one picture, outside of all layers"
                                          : "its layers are " + first_of(names)));
}

ChannelsOfPicture::ChannelsOfPicture(PictureLayer picture, const std::vector<Channel> &of_file,
                                     const std::string &depth)
    : own_(std::move(picture)) {
    if (find_channel(of_file, depth) != npos)
        asked_depth_ = depth;
    else
        depth_ = own_depth(own_, names_with_light(of_file));
    for (const PictureLayer &other : with_beauty(of_file))
        if (other.beauty != own_.beauty)
            others_.insert(other.prefix.empty() ? other.beauty + "." : other.prefix);
}

bool ChannelsOfPicture::owns(const std::string &channel) const {
    const std::string own = own_.prefix.empty() ? own_.beauty + "." : own_.prefix;
    return channel.starts_with(own) && std::ranges::none_of(others_, [&](const std::string &other) {
               return other.size() > own.size() && channel.starts_with(other);
           });
}

std::string ChannelsOfPicture::name_of(const std::string &channel) const {
    for (const char *name : colours)
        if (channel == own_.beauty + "." + name) return name;
    if (const std::string own = lower_case(depth_); own.ends_with(".z") && !own.ends_with("depth.z"))
        for (const std::string end : {"", "Back"})
            if (lower_case(channel) == own + lower_case(end)) return "Z" + end;
    if (!asked_depth_.empty() && (channel == asked_depth_ || channel == asked_depth_ + "Back"))
        return channel;
    return !owns(channel) && belongs_to_others(channel) ? "" : channel;
}

bool ChannelsOfPicture::belongs_to_others(const std::string &channel) const {
    static constexpr std::array depths{"Z", "ZBack", "depth.Z", "depth.ZBack"};
    if (is_among(colours, channel) || (!depth_.empty() && is_among(depths, channel))) return true;
    for (std::size_t dot = channel.find('.'); dot != std::string::npos; dot = channel.find('.', dot + 1))
        if (others_.contains(channel.substr(0, dot + 1))) return true;
    return false;
}

std::string full_name(const std::string &channel, const std::string &part, bool one_of_several) {
    if (!one_of_several || part.empty() || channel.starts_with(part + ".")) return channel;
    return part + "." + channel;
}

std::vector<Channel> full_channels(const Imf::MultiPartInputFile &file, const std::vector<int> &parts,
                                   const std::string &view, const std::string &path) {
    std::vector<Channel> all;
    for (const int part : parts)
        for (FileChannel &found : channels_of(file.header(part), view, path)) {
            found.channel.name = full_name(found.channel.name, layer_of(file.header(part)), file.parts() > 1);
            all.push_back(std::move(found.channel));
        }
    return all;
}

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
    return only(channels, [](const std::string &name) { // G and B of a depth in R, G and B repeat it
        const std::string last = colour_name(name.substr(name.rfind('.') + 1));
        return name.find("depth") != name.npos && last != "G" && last != "B" && last != "A";
    });
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

DepthChannel depth_of(const std::vector<Channel> &channels, const std::string &asked,
                      const std::string &path) {
    if (asked.empty() && !has_depth_channel(channels, asked)) {
        const std::size_t red = find_channel(channels, "R");
        if (channels.size() == 1 || red != npos)
            return find_depth_channel(channels, channels[channels.size() == 1 ? 0 : red].name, path);
    }
    return find_depth_channel(channels, asked, path);
}

namespace {

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

FlatFile read_depth_file(const PictureChoice &choice) {
    const std::string &name = choice.depth_file;
    const bool stereo = !choice.stereo_view.empty() && !stereo_views(name).empty();
    return read_flat_exr(name, {.stereo_view = stereo ? choice.stereo_view : std::string()});
}

void put_depth_of_file(FlatFile &picture, const std::string &path, const PictureChoice &choice,
                       const FlatFile &file) {
    const std::string &name = choice.depth_file;
    const Windows &from = file.image.windows, &to = picture.image.windows;
    if (from.display != to.display || from.pixel_aspect != to.pixel_aspect)
        throw Error(
            fmt::format("{}: its display window or its pixel aspect ratio is not that of {}, whose depth "
                        "it is to hold (`depth_file`)",
                        display_name(name), display_name(path)));
    const DepthChannel depth = depth_of(file.image.channels, choice.depth, name);
    const auto values = file.image.plane(find_channel(file.image.channels, depth.name));
    const std::span<float> plane = new_depth(picture.image);
    const Imath::Box2i both = common_box(from.data, to.data);
    for (int y = both.min.y; y <= both.max.y; ++y)
        for (int x = both.min.x; x <= both.max.x; ++x)
            plane[to.index(Imath::V2i(x, y))] = values[from.index(Imath::V2i(x, y))];
    picture.notes.push_back(fmt::format("depth: {} of {}", depth.name, display_name(name)));
    if (depth.warning) picture.warnings.push_back(display_name(name) + ": " + *depth.warning);
}

} // namespace sparselens
