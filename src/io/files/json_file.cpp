#include "io/files/json_file.h"

#include "base/error.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sparselens {

namespace {

using Json = nlohmann::json;

constexpr int most_levels = 32;
constexpr std::size_t longest_shown = 60; // characters

} // namespace

Json read_json_file(const std::string &path) {
    const auto not_too_deep = [&](int level, Json::parse_event_t, const Json &) {
        if (level <= most_levels) return true;
        throw Error(
            fmt::format("{}: its JSON is nested deeper than {} levels", display_name(path), most_levels));
    };
    try {
        return Json::parse(read_text_file(path), not_too_deep);
    } catch (const Json::exception &error) {
        throw Error(fmt::format("{}: not JSON: {}", display_name(path), error.what()));
    }
}

std::string shown_in_message(const Json &value) {
    const std::string text = value.dump(-1, ' ', true); // ASCII only, because any byte may be the last
    return text.size() <= longest_shown ? text : text.substr(0, longest_shown) + "...";
}

} // namespace sparselens
