#include "viewing/pipe_request.h"

#include "base/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>

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
    if (!value.is_number_integer() || value.get<std::int64_t>() < least || value.get<std::int64_t>() > most)
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

void take(PipeRequest &request, const std::string &name, const Json &value) {
    constexpr int most_frame = 9'999'999;
    if (name == "ask")
        request.ask = ask_of(value);
    else if (name == "file")
        request.source.file = text_of(value, "file");
    else if (name == "settings")
        request.source.settings = settings_in(value, "settings");
    else if (name == "query")
        request.source.query = text_of(value, "query");
    else if (name == "frame")
        request.source.frame = whole_number(value, "frame", -most_frame, most_frame);
    else if (name == "level")
        request.level = whole_number(value, "level", 0, most_levels - 1);
    else if (name == "box")
        request.box = box_of(value);
    else if (name == "channels")
        request.channels = channels_of(value);
    else
        refuse("it has a name that is unknown");
}

} // namespace

PipeRequest parse_pipe_request(std::string_view text) {
    const auto not_too_deep = [](int level, Json::parse_event_t, const Json &) {
        if (level > deepest) refuse("it is nested too deep");
        return true;
    };
    const Json json = Json::parse(text, not_too_deep, false);
    if (!json.is_object()) refuse("it is not an object of JSON");
    if (!json.contains("ask")) refuse("it says not what to ask");
    PipeRequest request;
    for (const auto &[name, value] : json.items()) take(request, name, value);
    if (request.source.file.empty()) refuse("it names no file");
    if ((request.ask == Ask::tile) != request.box.has_value())
        refuse("a tile has a box, and nothing else has");
    return request;
}

} // namespace sparselens
