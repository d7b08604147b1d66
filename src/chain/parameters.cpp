#include "chain/parameters.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace sparselens {

namespace {

using Pair = std::pair<std::string_view, std::string_view>;
constexpr Pair exclusive[] = {{"lens-radius", "fstop"},         {"focus-pixel", "focus-distance"},
                              {"disparity", "depth"},           {"blur", "fstop"},
                              {"blur", "lens-radius"},          {"blur", "focal-length"},
                              {"blur", "sensor-width"},         {"aperture", "blades"},
                              {"aperture", "blade-curvature"},  {"aperture", "blade-rotation"},
                              {"display", "output-colorspace"}, {"view-transform", "output-colorspace"}};
constexpr Pair needed[] = {{"holdout-defocused", "holdout"},
                           {"highlight-threshold", "highlight-gain"},
                           {"highlight-knee", "highlight-gain"}};

} // namespace

std::span<const Parameter *const> picture_parameters() {
    static const auto rows =
        [](const auto &...parts) {
            std::vector<const Parameter *> all;
            const auto add = [&](const auto &part) {
                for (const Parameter &row : part) all.push_back(&row);
            };
            (add(parts), ...);
            return all;
        }(gather_parameters(), lens_parameters(), look_parameters(), depth_parameters(), choice_parameters(),
          kind_parameters(), depth_file_parameters(), photograph_parameters(), input_colour_parameters(),
          output_colour_parameters(), window_parameters(), shown_parameters());
    return rows;
}

const Parameter *find_parameter(std::string_view name) {
    const auto rows = picture_parameters();
    const auto found = std::ranges::find(rows, name, [](const Parameter *row) { return row->name; });
    return found == rows.end() ? nullptr : *found;
}

std::string keyword_of(std::string_view of) {
    std::string name(of);
    std::ranges::replace(name, '-', '_');
    return name;
}

bool exclude(std::string_view one, std::string_view other) {
    return std::ranges::count(exclusive, Pair(one, other)) + std::ranges::count(exclusive, Pair(other, one)) >
           0;
}
bool needs(std::string_view one, std::string_view other) {
    return std::ranges::count(needed, Pair(one, other)) > 0;
}

void check_together(const IsGiven &is_given) {
    for (const auto &[one, other] : exclusive) {
        const std::string first = keyword_of(one), second = keyword_of(other);
        if (is_given(first) && is_given(second))
            throw UsageError(fmt::format("`{}`: is given with `{}`; give one of the two", first, second));
    }
    for (const auto &[one, other] : needed) {
        const std::string first = keyword_of(one), second = keyword_of(other);
        if (is_given(first) && !is_given(second))
            throw UsageError(fmt::format("`{}`: is needed by `{}`", second, first));
    }
}

bool read_numbers(const std::string &text, std::span<double> numbers) {
    const char *at = text.data(), *const end = at + text.size();
    for (double &number : numbers) {
        if (&number != &numbers.front() && (at == end || *at++ != ',')) return false;
        if (at != end && *at == '+' && at[1] != '-') ++at;
        const auto [after, error] = std::from_chars(at, end, number);
        if (error != std::errc()) return false;
        at = after;
    }
    return at == end;
}

} // namespace sparselens
