#include "io/exr/exr_common.h"

#include "base/channel_kind.h"
#include "base/parallel.h"
#include "base/text.h"

#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <ImfTileDescription.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <set>

namespace sparselens {

namespace {

// Attributes that describe how one file stores its pixels; they must not be copied into another file. By
// BlenderMultiChannel, Blender would look for layers in a picture that has none.
bool describes_storage(const std::string &name) {
    static constexpr std::array names{
        "channels",         "chunkCount",    "compression", "dataWindow",
        "deepImageState",   "displayWindow", "lineOrder",   "maxSamplesPerPixel",
        "pixelAspectRatio", "preview",       "tiles",       "type",
        "version"};
    static constexpr std::array of_pixels{"oiio:SHA-1", "oiio:AverageColor",
                                          "oiio:ConstantColor", // of textures
                                          "textureformat", "wrapmodes"};
    return is_among(names, name) || is_among(of_pixels, name) || name == kept_names_attribute ||
           name == "BlenderMultiChannel" || name.starts_with("photograph:"); // io/photograph.h
}

} // namespace

Windows windows_of(const Imf::Header &header) {
    return {header.displayWindow(), header.dataWindow(), header.pixelAspectRatio()};
}

double memory_of(const Imf::Header &header, std::size_t values) {
    const Imath::Box2i &data = header.dataWindow();
    const double width = double(data.max.x) - double(data.min.x) + 1;
    const double height = double(data.max.y) - double(data.min.y) + 1;
    double pixels = width * height;
    if (header.hasTileDescription()) {
        const Imf::TileDescription &tile = header.tileDescription();
        pixels += double(tile.xSize) * double(tile.ySize);
    }
    return pixels * double(values * sizeof(float));
}

std::string first_of(const std::vector<std::string> &names) {
    constexpr std::size_t most = 40; // keeps the line readable
    const std::size_t listed = std::min(most, names.size());
    const std::string list =
        fmt::format("{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(listed), ", "));
    return listed == names.size() ? list : fmt::format("{} and {} more", list, names.size() - listed);
}

bool is_position_channel(const std::string &channel) {
    static constexpr std::array names{"Z",          "ZBack",       "ldi.dx",   "ldi.dy",
                                      "ldi.weight", "ldi.optical", "ldi.solid"};
    return is_among(names, channel);
}

Imf::Header output_header(const Windows &windows, std::span<const Channel> channels,
                          const Imf::Header &metadata) {
    Imf::Header header(windows.display, windows.data, windows.pixel_aspect);
    for (auto it = metadata.begin(); it != metadata.end(); ++it)
        if (!describes_storage(it.name())) header.insert(it.name(), it.attribute());
    for (const Channel &channel : channels)
        header.channels().insert(channel.name, Imf::Channel(imf_type(channel.type)));
    return header;
}

Imf::PixelType imf_type(PixelType type) {
    switch (type) {
    case PixelType::half: return Imf::HALF;
    case PixelType::uint32: return Imf::UINT;
    case PixelType::float32: break;
    }
    return Imf::FLOAT;
}

std::size_t bytes_of(PixelType type) { return type == PixelType::half ? 2 : 4; }

namespace {

std::size_t store_halves(const float *from, std::size_t count, char *to) {
    constexpr float largest = 65504, rounded_up = 65520; // from here on a half would be infinite
    std::size_t clamped = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const float value = std::isfinite(from[i]) ? std::clamp(from[i], -largest, largest) : from[i];
        if (std::isfinite(from[i]) && std::abs(from[i]) >= rounded_up) ++clamped;
        const Imath::half rounded(value);
        std::memcpy(to + 2 * i, &rounded, 2);
    }
    return clamped;
}

} // namespace

std::size_t store(PixelType type, const float *from, std::size_t count, char *to) {
    if (count == 0) return 0; // the pointers may be null then
    const std::size_t size = bytes_of(type);
    std::atomic<std::size_t> clamped = 0;
    parallel_ranges(count, 65536, [&](std::size_t begin, std::size_t end) {
        if (type == PixelType::half)
            clamped += store_halves(from + begin, end - begin, to + begin * size);
        else
            std::memcpy(to + begin * size, from + begin,
                        (end - begin) * size); // ids keep their bits, see PixelType
    });
    return clamped;
}

namespace {
constexpr const char *prefix = "cryptomatte/";
} // namespace

std::vector<std::string> matte_names(const Imf::Header &header) {
    std::vector<std::string> names;
    for (auto it = header.begin(); it != header.end(); ++it) {
        const std::string name = it.name();
        const auto *text = dynamic_cast<const Imf::StringAttribute *>(&it.attribute());
        if (text && name.starts_with(prefix) && name.ends_with("/name")) names.push_back(text->value());
    }
    return names;
}

Imf::Header with_mattes_of(const Imf::MultiPartInputFile &file, Imf::Header header) {
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header &other = file.header(part);
        for (auto it = other.begin(); it != other.end(); ++it)
            if (std::string(it.name()).starts_with(prefix) && header.find(it.name()) == header.end())
                header.insert(it.name(), it.attribute());
    }
    return header;
}

namespace {

constexpr const char *data_attribute = "sparselens:data", *light_attribute = "sparselens:light";

std::vector<std::string> stated_names(const Imf::Header &header, const char *attribute) {
    const auto *names = header.findTypedAttribute<Imf::StringVectorAttribute>(attribute);
    return names ? names->value() : Imf::StringVector();
}

void set_names(Imf::Header &header, const char *attribute, const std::vector<std::string> &names) {
    if (!names.empty())
        set_attribute(header, attribute, Imf::StringVectorAttribute(names));
    else if (header.find(attribute) != header.end())
        header = without_attribute(header, attribute);
}

// Adds the names of a list to an attribute, and takes them from the other one. Throws Error if a name is that of no
// channel and no layer.
void state_names(Imf::Header &header, const char *attribute, const char *other, const char *parameter,
                 const std::string &list, std::span<const Channel> channels, const std::string &path) {
    std::vector<std::string> names = stated_names(header, attribute), others = stated_names(header, other);
    for (const std::string &name : words_between_commas(list)) {
        if (std::ranges::none_of(channels, [&](const Channel &channel) { return is_named(channel, name); }))
            throw Error(
                fmt::format("{}: has no layer or channel {} (`{}`)", display_name(path), name, parameter));
        if (!is_among(names, name)) names.push_back(name);
        std::erase(others, name);
    }
    set_names(header, attribute, names);
    set_names(header, other, others);
}

} // namespace

Imf::Header with_stated_kinds(Imf::Header header, const PictureChoice &choice,
                              std::span<const Channel> channels, const std::string &path) {
    state_names(header, data_attribute, light_attribute, "data", choice.data, channels, path);
    state_names(header, light_attribute, data_attribute, "light", choice.light, channels, path);
    return header;
}

void find_kinds_by(const Imf::Header &header, std::span<Channel> channels) {
    find_kinds(channels, matte_names(header),
               {stated_names(header, data_attribute), stated_names(header, light_attribute)});
}

void find_kinds_by(const Imf::Header &header, std::vector<FileChannel> &channels) {
    std::vector<Channel> plain;
    for (const FileChannel &found : channels) plain.push_back(found.channel);
    find_kinds_by(header, plain);
    for (std::size_t k = 0; k < channels.size(); ++k) channels[k].channel = plain[k];
}

void set_kept_names(Imf::Header &header, const KeptNames &names) {
    if (header.find(kept_names_attribute) != header.end())
        header = without_attribute(header, kept_names_attribute);
    Imf::StringVector pairs;
    for (const auto &[known, in_file] : names) pairs.insert(pairs.end(), {known, in_file});
    if (!pairs.empty()) header.insert(kept_names_attribute, Imf::StringVectorAttribute(pairs));
}

void name_colours(std::span<Channel> channels, Imf::Header &header) {
    const std::vector<std::string> known = names_of_colours(channels);
    KeptNames kept;
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (channels[k].name != known[k]) {
            kept[known[k]] = channels[k].name;
            channels[k].name = known[k];
        }
    set_kept_names(header, kept);
}

std::vector<Channel> by_kept_names(std::span<const Channel> channels, const Imf::Header &metadata) {
    std::vector<Channel> named(channels.begin(), channels.end());
    const auto *attribute = metadata.findTypedAttribute<Imf::StringVectorAttribute>(kept_names_attribute);
    if (!attribute) return named;
    std::set<std::string> taken;
    for (const Channel &channel : channels) taken.insert(channel.name);
    const Imf::StringVector &pairs = attribute->value();
    for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
        if (const std::size_t k = find_channel(channels, pairs[i]);
            k != npos && !taken.contains(pairs[i + 1])) {
            taken.insert(pairs[i + 1]);
            named[k].name = pairs[i + 1];
        }
    return named;
}

} // namespace sparselens
