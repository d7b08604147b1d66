#include "harness/commands/keys.h"

#include "base/error.h"
#include "base/text.h"
#include "io/files/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace sparselens {

namespace {

constexpr std::ptrdiff_t most_digits = 9; // in a frame number

std::optional<KeyValue> parse_value(std::string_view text, KeyKind kind) {
    const bool two = kind != KeyKind::number;
    const std::size_t comma = two ? text.find(',') : text.size();
    if (comma == text.npos) return {};
    const auto x = number_of<double>(text.substr(0, comma));
    const auto y = two ? number_of<double>(text.substr(comma + 1)) : std::optional<double>(0);
    if (!x || !y) return {};
    const auto is_whole = [](double v) { return std::isfinite(v) && std::trunc(v) == v; };
    if (kind == KeyKind::pixel && !(is_whole(*x) && is_whole(*y))) return {};
    return KeyValue{*x, *y};
}

// Adds FRAME:VALUE; false if the text is something else.
bool add_key(Keys &keys, std::string_view text) {
    const std::size_t colon = text.find(':');
    if (colon == text.npos) return false;
    const std::string_view number = text.substr(0, colon);
    const bool percent = keys.kind == KeyKind::number && text.ends_with('%');
    const auto frame = number_of<int>(number);
    const auto value =
        parse_value(text.substr(colon + 1, text.size() - colon - 1 - std::size_t(percent)), keys.kind);
    if (keys.by_frame.empty()) keys.percent = percent;
    if (percent != keys.percent || !frame || !value ||
        std::ssize(number) > most_digits + (number.starts_with('-') ? 1 : 0))
        return false;
    if (!keys.by_frame.emplace(*frame, *value).second)
        throw UsageError(fmt::format("frame {} has two keys, the second is '{}'", *frame, text));
    return true;
}

// Adds the keys of a list; false if the text is not a list.
bool add_keys(Keys &keys, std::string_view text) {
    const char separator = keys.kind == KeyKind::number ? ',' : ';';
    for (std::size_t from = 0, to = 0; to < text.size(); from = to + 1) {
        to = std::min(text.find(separator, from), text.size());
        if (!add_key(keys, text.substr(from, to - from))) return false;
    }
    return !text.empty() && text.back() != separator;
}

// The name of the option in a file of JSON: "focus_distance" for --focus-distance.
std::string json_name(std::string_view option) {
    std::string name(option.substr(std::min(option.find_first_not_of('-'), option.size())));
    std::ranges::replace(name, '-', '_');
    return name;
}

// The value as a list of keys has it: dof-match writes "inf" for an infinite number. Empty for other values.
std::string key_text(const std::string &frame, const nlohmann::json &value) {
    if (value.is_number()) return frame + ":" + value.dump();
    return value.is_string() ? frame + ":" + value.get<std::string>() : "";
}

Keys json_keys(const std::string &path, const std::string &text, KeyKind kind, std::string_view option) {
    const std::string name = json_name(option);
    const nlohmann::json file = nlohmann::json::parse(text, nullptr, false);
    if (file.is_discarded()) throw UsageError(path + ": is neither a list of keys nor valid JSON");
    const auto found = file.find(name);
    if (found == file.end() || !found->is_object() || found->empty())
        throw UsageError(fmt::format("{}: has no \"{}\" with a value for each frame", path, name));
    Keys keys{.kind = kind};
    for (const auto &[frame, value] : found->items())
        if (!add_key(keys, key_text(frame, value)))
            throw UsageError(fmt::format("{}: \"{}\" has no number at frame {}", path, name, frame));
    return keys;
}

} // namespace

std::optional<Keys> parse_keys(std::string_view text, KeyKind kind) {
    Keys keys{.kind = kind};
    if (!add_keys(keys, text)) return {};
    return keys;
}

Keys read_keys(const std::string &path, KeyKind kind, std::string_view option) {
    const std::string text = read_text_file(path);
    if (trimmed(text).starts_with('{')) return json_keys(path, text, kind, option);
    Keys keys{.kind = kind};
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::string_view list = trimmed(line);
        if (list.empty() || list.starts_with('#')) continue;
        if (!add_keys(keys, list))
            throw UsageError(fmt::format("{}: line {} is '{}', not {}", path, number, list,
                                         kind != KeyKind::number ? "FRAME:X,Y (e.g. 1:320,180)"
                                                                 : "FRAME:VALUE (e.g. 1:5.0)"));
    }
    if (keys.by_frame.empty()) throw UsageError(path + ": holds no keys, such as 1:5.0");
    return keys;
}

std::string word_at_frame(const Keys &keys, int frame) {
    const auto word = [&](const KeyValue &value) {
        if (keys.kind == KeyKind::number) return fmt::format("{}{}", value.x, keys.percent ? "%" : "");
        return keys.kind == KeyKind::pixel ? fmt::format("{:.0f},{:.0f}", value.x, value.y)
                                           : fmt::format("{},{}", value.x, value.y);
    };
    const auto after = keys.by_frame.lower_bound(frame);
    if (after == keys.by_frame.end()) return word(keys.by_frame.rbegin()->second);
    if (after->first == frame || after == keys.by_frame.begin()) return word(after->second);
    const auto &[first, from] = *std::prev(after);
    const double t = double(frame - first) / double(after->first - first);
    const auto mix = [t](double a, double b) {
        return (1 - t) * a + t * b;
    }; // keeps an infinite end infinite
    return word({mix(from.x, after->second.x), mix(from.y, after->second.y)});
}

} // namespace sparselens
