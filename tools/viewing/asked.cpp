#include "viewing/asked.h"

#include "base/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

namespace sparselens {

namespace {

using Json = nlohmann::json;

constexpr std::size_t most_settings = 64, longest_value = 64, longest_page = 32;

bool is_alphanumeric(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }
bool is_of_value(char c) {
    return is_alphanumeric(c) || std::string_view("+-.,_").find(c) != std::string_view::npos;
}

[[noreturn]] void refuse(const char *what) { throw UsageError(std::string("the request: ") + what); }

const std::string &text_of(const Json &value, const char *what) {
    if (!value.is_string()) refuse(what);
    return value.get_ref<const std::string &>();
}

std::string page_of(const Json &value) {
    const std::string &page = text_of(value, "page is not a word");
    if (page.empty() || page.size() > longest_page || !std::ranges::all_of(page, is_alphanumeric))
        refuse("page is not a word of at most 32 letters and digits");
    return page;
}

std::map<std::string, std::string> settings_of(const Json &object) {
    if (!object.is_object() || object.size() > most_settings)
        refuse("settings are not an object of at most 64 values");
    std::map<std::string, std::string> settings;
    for (const auto &[name, given] : object.items()) {
        const std::string &value = text_of(given, "a setting is not text");
        if (value.size() > longest_value || !std::ranges::all_of(value, is_of_value))
            refuse("a setting is longer than 64 letters, digits and +-.,_");
        settings[name] = value;
    }
    return settings;
}

std::string format_of(const Json &value) {
    if (value != "exr" && value != "png") refuse("format is neither exr nor png");
    return value.get<std::string>();
}

double exposure_of(const Json &value) {
    constexpr double most = 20;
    if (!value.is_number() || !(std::abs(value.get<double>()) <= most))
        refuse("exposure is not a number from -20 to 20");
    return value.get<double>();
}

bool is_whole(const Json &n) {
    constexpr std::int64_t most = 1 << 30;
    return n.is_number_integer() && n.get<std::int64_t>() >= -most && n.get<std::int64_t>() <= most;
}

int frame_of(const Json &value) {
    if (!is_whole(value)) refuse("frame is not a whole number");
    return value.get<int>();
}

Imath::V2i pixel_of(const Json &value) {
    if (!value.is_array() || value.size() != 2 || !std::ranges::all_of(value, is_whole))
        refuse("pixel is not two whole numbers");
    return {value[0].get<int>(), value[1].get<int>()};
}

Imath::Box2i region_of(const Json &value) {
    if (!value.is_array() || value.size() != 4 || !std::ranges::all_of(value, is_whole))
        refuse("region is not four whole numbers");
    const Imath::Box2i box({value[0].get<int>(), value[1].get<int>()},
                           {value[2].get<int>(), value[3].get<int>()});
    if (box.isEmpty()) refuse("region is empty");
    return box;
}

} // namespace

Asked parse_asked(std::string_view text) {
    if (text.size() > most_asked) refuse("it is too long");
    const Json json = Json::parse(text, nullptr, false); // no exceptions
    if (!json.is_object()) refuse("it is not an object of JSON");
    Asked asked;
    for (const auto &[name, value] : json.items()) {
        if (name == "page")
            asked.page = page_of(value);
        else if (name == "settings")
            asked.settings = settings_of(value);
        else if (name == "frame")
            asked.frame = frame_of(value);
        else if (name == "format")
            asked.format = format_of(value);
        else if (name == "exposure")
            asked.exposure = exposure_of(value);
        else if (name == "pixel")
            asked.pixel = pixel_of(value);
        else if (name == "region")
            asked.region = region_of(value);
        else
            refuse("it has a name that is unknown");
    }
    if (asked.page.empty()) refuse("it says no page");
    return asked;
}

} // namespace sparselens
