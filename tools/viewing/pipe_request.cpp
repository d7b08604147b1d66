#include "viewing/pipe_request.h"

#include "base/error.h"
#include "io/exr/exr_flat.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <map>
#include <regex>

namespace sparselens {

namespace {

using Json = nlohmann::json;

constexpr int deepest = 8;
constexpr std::size_t most_channels = 4096;

[[noreturn]] void refuse(const std::string &what) { throw UsageError("the request: " + what); }

const std::string &text_of(const Json &value, const char *name) {
    if (!value.is_string()) refuse(fmt::format("{} is not text", name));
    const auto &text = value.get_ref<const std::string &>();
    if (text.find('\0') != std::string::npos) refuse(fmt::format("{} has a zero byte", name));
    return text;
}

int whole_number(const Json &value, const char *name, int least, int most) {
    // Not as std::int64_t: a number beyond its range would become another one.
    if (!value.is_number_integer() || value.get<double>() < least || value.get<double>() > most)
        refuse(fmt::format("{} is not a whole number from {} to {}", name, least, most));
    return value.get<int>();
}

Ask ask_of(const Json &value) {
    static const std::map<std::string, Ask> asks{
        {"facts", Ask::facts}, {"header", Ask::header}, {"picture", Ask::picture}, {"tile", Ask::tile}};
    const auto found = asks.find(text_of(value, "ask"));
    if (found == asks.end()) refuse("ask is none of facts, header, picture and tile");
    return found->second;
}

Imath::Box2i box_of(const Json &value) {
    constexpr int most = 1 << 30;
    if (!value.is_array() || value.size() != 4) refuse("box is not four whole numbers");
    int v[4] = {};
    for (std::size_t i = 0; i < 4; ++i) v[i] = whole_number(value[i], "box", -most, most);
    if (v[0] > v[2] || v[1] > v[3]) refuse("box is empty");
    return {{v[0], v[1]}, {v[2], v[3]}};
}

std::vector<std::string> channels_of(const Json &value) {
    if (!value.is_array() || value.empty() || value.size() > most_channels)
        refuse("channels is not a list of names");
    std::vector<std::string> channels;
    for (const Json &name : value) channels.push_back(text_of(name, "a channel"));
    return channels;
}

bool flag_of(const Json &value, const char *name) {
    if (!value.is_boolean()) refuse(fmt::format("{} is neither true nor false", name));
    return value.get<bool>();
}

float aspect_of(const Json &value) {
    constexpr double most = 100;
    if (!value.is_number() || !(value.get<double>() >= 1 / most && value.get<double>() <= most))
        refuse("pixel_aspect is not a number from 0.01 to 100");
    return value.get<float>();
}

HandedLayout layout_of(const Json &object) {
    if (!object.is_object()) refuse("picture is not an object of JSON");
    HandedLayout layout;
    Windows &windows = layout.windows;
    const ByName functions{
        {"display", [&](const Json &value) { windows.display = box_of(value); }},
        {"data", [&](const Json &value) { windows.data = box_of(value); }},
        {"channels", [&](const Json &value) { layout.channels = channels_of(value); }},
        {"pixel_aspect", [&](const Json &value) { windows.pixel_aspect = aspect_of(value); }},
        {"shown", [&](const Json &value) { layout.shown = flag_of(value, "shown"); }}};
    if (!take_by_name(object, functions)) refuse("its picture has a name that is unknown");
    const Imath::Box2i &data = windows.data;
    if (windows.display.isEmpty() || data.isEmpty() || layout.channels.empty())
        refuse("its picture needs display, data and channels");
    constexpr std::int64_t most = 1 << 17; // pixels along a side
    if (std::int64_t{data.max.x} - data.min.x >= most || std::int64_t{data.max.y} - data.min.y >= most)
        refuse("its picture is too large");
    return layout;
}

} // namespace

PipeRequest parse_pipe_request(std::string_view text) {
    const auto not_too_deep = [](int level, Json::parse_event_t, const Json &) {
        if (level > deepest) refuse("it is nested too deep");
        return true;
    };
    const Json json = Json::parse(text, not_too_deep, false);
    if (!json.is_object()) refuse("it is not an object of JSON");
    if (!json.contains("ask")) refuse("it has no ask");
    PipeRequest request;
    PictureSource &source = request.source;
    constexpr int most_frame = 9'999'999;
    const ByName functions{
        {"ask", [&](const Json &value) { request.ask = ask_of(value); }},
        {"file", [&](const Json &value) { source.file = text_of(value, "file"); }},
        {"settings", [&](const Json &value) { source.settings = settings_in(value, "settings"); }},
        {"query", [&](const Json &value) { source.query = text_of(value, "query"); }},
        {"frame",
         [&](const Json &value) { source.frame = whole_number(value, "frame", -most_frame, most_frame); }},
        {"level",
         [&](const Json &value) { request.level = whole_number(value, "level", 0, most_levels - 1); }},
        {"box", [&](const Json &value) { request.box = box_of(value); }},
        {"channels", [&](const Json &value) { request.channels = channels_of(value); }},
        {"shown", [&](const Json &value) { request.shown = flag_of(value, "shown"); }},
        {"picture", [&](const Json &value) { request.handed = layout_of(value); }}};
    if (!take_by_name(json, functions)) refuse("it has a name that is unknown");
    if (source.file.empty() && !request.handed) refuse("it names no file");
    if (!source.file.empty() && request.handed) refuse("it has a file and a picture");
    if ((request.ask == Ask::tile) != request.box.has_value())
        refuse("a tile has a box, and nothing else has");
    return request;
}

namespace {

constexpr const char *name = "the picture that was handed over";

Image image_of(const HandedLayout &layout, const std::string &pixels) {
    std::vector<Channel> channels;
    for (const std::string &channel : layout.channels) channels.push_back({channel, PixelType::float32});
    Image image(layout.windows, std::move(channels));
    const std::size_t count = layout.channels.size();
    for (std::size_t k = 0; k < count; ++k) {
        const std::span<float> plane = image.plane(k);
        for (std::size_t i = 0; i < plane.size(); ++i)
            std::memcpy(&plane[i], pixels.data() + (i * count + k) * sizeof(float), sizeof(float));
    }
    return image;
}

} // namespace

std::string InMemoryPictures::path_of(const HandedLayout &layout, std::string pixels) {
    if (pixels.size() != layout.bytes())
        throw UsageError(fmt::format("the request: {} has {} bytes of pixels instead of {}", name,
                                     pixels.size(), layout.bytes()));
    const auto as_file = [](const auto &handed) {
        const Imf::Header no_metadata;
        return std::make_unique<const MemoryFile>(
            flat_exr(name, image_of(handed.first, handed.second), no_metadata, Imf::NO_COMPRESSION));
    };
    return kept_.get({layout, std::move(pixels)}, as_file)->path();
}

std::string InMemoryPictures::in_words(std::string message) {
    static const std::regex path("/proc/self/fd/[0-9]+");
    return std::regex_replace(message, path, name);
}

} // namespace sparselens
