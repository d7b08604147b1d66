#include "io/shutter_file.h"

#include "base/error.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

namespace sparselens {

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
