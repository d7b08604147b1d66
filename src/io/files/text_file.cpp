#include "io/files/text_file.h"

#include "base/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace sparselens {

namespace {

// The most bytes that OpenEXR's streams take at once.
constexpr std::size_t most_at_once = std::numeric_limits<int>::max();

std::string contents_of(const std::string &path, Content content) {
    const auto stream = open_input(path, content);
    std::string contents(std::size_t(stream->size()), '\0');
    for (std::size_t done = 0; done < contents.size();) {
        const std::size_t count = std::min(contents.size() - done, most_at_once);
        stream->read(contents.data() + done, int(count));
        done += count;
    }
    return contents;
}

} // namespace

std::string read_text_file(const std::string &path) { return contents_of(path, Content::text); }
std::string read_bytes(const std::string &path) { return contents_of(path, Content::bytes); }

void write_text_file(const std::string &path, std::string_view contents) {
    OutputFile file(path);
    while (!contents.empty()) {
        const std::size_t count = std::min(contents.size(), most_at_once);
        file.stream().write(contents.data(), int(count));
        contents.remove_prefix(count);
    }
    file.commit();
}

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

MemoryFile::MemoryFile(std::string_view contents) {
    if (file_.number() < 0) fail_of_system("a file in memory", "cannot make");
    write_all("a file in memory", file_.number(), contents);
}

bool MemoryFile::can_hold(std::size_t bytes) const {
    const std::uint64_t size = system::size_of(file_.number()).value_or(0);
    return system::resize(file_.number(), std::max<std::uint64_t>(size, bytes)) &&
           system::resize(file_.number(), size);
}

} // namespace sparselens
