#include "io/moment_files.h"

#include "base/error.h"
#include "base/system/system.h"
#include "base/text.h"
#include "io/exr/exr_header.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"

#include <ImfIntAttribute.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

namespace sparselens {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view placeholder = moment_placeholder;
constexpr const char *moment_name = "sparselens:moment", *moments_name = "sparselens:moments";

// The number that a text of digits spells; a longer text is no number of a moment.
std::optional<int> number_in(std::string_view text) {
    constexpr std::size_t most_digits = 6;
    if (text.empty() || text.size() > most_digits ||
        text.find_first_not_of("0123456789") != std::string_view::npos)
        return {};
    return number_of<int>(text);
}

// The numbers of files that exist, with their spelling.
std::vector<std::pair<int, std::string>> found_on_disk(const std::string &path) {
    const std::size_t at = path.find(placeholder, existing_folders(path)),
                      slash = path.find_last_of(system::separators, at) + 1; // 0 if there is none
    const std::string folder = slash > 0 ? path.substr(0, slash) : ".",
                      first = path.substr(slash, at - slash), after = path.substr(at + placeholder.size()),
                      last = after.substr(0, after.find_first_of(system::separators));
    std::vector<std::pair<int, std::string>> found;
    std::error_code error, missing; // a folder that is not there has no files
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.size() <= first.size() + last.size() || !name.starts_with(first) || !name.ends_with(last))
            continue;
        const std::string middle = name.substr(first.size(), name.size() - first.size() - last.size());
        const std::optional<int> number = number_in(middle);
        if (number && fs::exists(at_moment(path, middle), missing)) found.emplace_back(*number, middle);
    }
    std::ranges::sort(found);
    return found;
}

} // namespace

std::size_t existing_folders(const std::string &path) {
    std::error_code missing;
    std::size_t length = path.find_last_of(system::separators) + 1; // 0 if there is none
    while (length > 1 && !fs::is_directory(path.substr(0, length), missing))
        length = path.find_last_of(system::separators, length - 2) + 1;
    return length;
}

std::string with_placeholder(std::string path, std::string_view sign, const std::string &text) {
    for (std::size_t at = existing_folders(path); (at = path.find(sign, at)) != std::string::npos;
         at += text.size())
        path.replace(at, sign.size(), text);
    return path;
}

bool names_moments(const std::string &path) {
    std::error_code error;
    return path.find(placeholder, existing_folders(path)) != std::string::npos && !fs::exists(path, error);
}

std::string at_moment(std::string path, const std::string &number) {
    return with_placeholder(std::move(path), placeholder, number);
}

std::string without_moment(std::string path) {
    for (std::size_t at = existing_folders(path); (at = path.find(placeholder, at)) != std::string::npos;) {
        const std::size_t before = at > 0 && std::string_view("._-").find(path[at - 1]) < 3 ? 1 : 0;
        path.erase(at -= before, before + placeholder.size());
    }
    return path;
}

std::vector<std::string> moments_on_disk(const std::string &path) {
    const auto found = found_on_disk(path);
    if (found.empty())
        throw Error(fmt::format("{}: there is no such file; %s stands for the number of a moment, as in {}",
                                path, at_moment(path, "0")));
    std::vector<std::string> numbers;
    for (const auto &[number, spelled] : found) numbers.push_back(spelled);
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i].first != found.front().first + int(i))
            throw Error(fmt::format("{}: the moments must be numbered without a gap, and there are {}", path,
                                    fmt::join(numbers, ", ")));
    return numbers;
}

std::optional<StatedMoment> stated_moment(const Imf::Header &header) {
    const auto *moment = header.findTypedAttribute<Imf::IntAttribute>(moment_name);
    const auto *moments = header.findTypedAttribute<Imf::IntAttribute>(moments_name);
    if (!moment || !moments) return {};
    return StatedMoment{moment->value(), moments->value()};
}

void write_stated_moment(Imf::Header &header, const StatedMoment &moment) {
    header.insert(moment_name, Imf::IntAttribute(moment.moment));
    header.insert(moments_name, Imf::IntAttribute(moment.moments));
}

Imf::Header without_stated_moment(const Imf::Header &header) {
    return without_attribute(without_attribute(header, moment_name), moments_name);
}

namespace {

// Reads two numbers that are separated by blanks or a comma.
bool read_point(std::string_view line, ShutterCurve::Point &point) {
    for (double *number : {&point.time, &point.value}) {
        const std::size_t begin = line.find_first_not_of(" \t,");
        if (begin == std::string_view::npos) return false;
        line.remove_prefix(begin);
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), *number);
        if (error != std::errc()) return false;
        line.remove_prefix(std::size_t(end - line.data()));
    }
    return line.find_first_not_of(" \t\r") == std::string_view::npos;
}

// Says what is wrong with the curve; empty if nothing is.
std::string fault_of(const std::vector<ShutterCurve::Point> &points) {
    if (points.size() < 2 || points.front().time != 0 || points.back().time != 1)
        return "its times must go from 0, when the shutter opens, to 1, when it closes";
    const auto not_after = [](double one, double next) { return !(next > one); };
    if (std::ranges::adjacent_find(points, not_after, &ShutterCurve::Point::time) != points.end())
        return "its times must ascend";
    if (!std::ranges::all_of(
            points, [](double v) { return v >= 0 && std::isfinite(v); }, &ShutterCurve::Point::value))
        return "its values must be at least 0";
    if (std::ranges::all_of(
            points, [](double v) { return v == 0; }, &ShutterCurve::Point::value))
        return "one of its values must be above 0";
    return {};
}

ShutterCurve read_shutter_file(const std::string &path) {
    std::istringstream text(read_text_file(path));
    ShutterCurve curve;
    int number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        if (line.starts_with('#') || line.find_first_not_of(" \t\r") == std::string::npos) continue;
        if (!read_point(line, curve.points.emplace_back()))
            throw Error(fmt::format("{}: line {} must be a time and a value of the shutter, e.g. 0.25 1",
                                    display_name(path), number));
    }
    if (const std::string fault = fault_of(curve.points); !fault.empty())
        throw Error(fmt::format("{}: {}", display_name(path), fault));
    return curve;
}

} // namespace

ShutterCurve shutter_curve(const std::string &name) {
    if (name.empty() || name == "box") return box_shutter();
    if (name == "triangle") return triangle_shutter();
    if (name == "gaussian") return gaussian_shutter();
    return read_shutter_file(name);
}

} // namespace sparselens
