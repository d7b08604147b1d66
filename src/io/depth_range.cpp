#include "io/depth_range.h"

#include "base/error.h"
#include "deep/checks/picture_checks.h"
#include "io/exr/header_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

namespace sparselens {

namespace {

std::optional<double> number_in(const Imf::Header &header, std::initializer_list<const char *> names) {
    const std::vector<HeaderValue> values = header_values(header);
    for (const char *name : names)
        if (const HeaderValue *found = find_value(values, name); found && found->numbers.size() == 1)
            return found->numbers[0];
    return {};
}

bool are_inverse(const Grid &grid, std::span<const float> depths) {
    const Image no_channels(windows_of_size(grid.width(), grid.height()), {});
    return looks_inverse(slopes_of_depth({"", no_channels, {depths.begin(), depths.end()}}));
}

} // namespace

DepthRange depth_range(const DepthOptions &options, const Imf::Header &header) {
    const bool hyperbolic = options.meaning == DepthMeaning::hyperbolic;
    if (options.meaning != DepthMeaning::normalized && !hyperbolic) {
        if (options.near)
            throw UsageError("`near` works with `depth=normalized` and `depth=hyperbolic` only");
        return {0, options.far.value_or(DepthRange().far)};
    }
    const char *word = hyperbolic ? "hyperbolic" : "normalized";
    const auto near = options.near ? options.near : number_in(header, {"near", "nearClip", "clipNear"});
    const auto far = options.far ? options.far : number_in(header, {"far", "farClip", "clipFar"});
    if (!near || !far)
        throw UsageError(fmt::format("`depth={}`: which depth is {} is unknown: give {}", word,
                                     near ? "1" : (far ? "0" : "0 and which is 1"),
                                     near ? "`far`" : (far ? "`near`" : "`near` and `far`")));
    if (!(*near > 0 && *far > 0 && *near != *far))
        throw UsageError(
            fmt::format("`depth={}`: `near` and `far` must be above 0 and not the same: they are "
                        "{:g} and {:g}",
                        word, *near, *far));
    return {*near, *far};
}

std::optional<std::string> normalized_warning(const DepthOptions &options, std::span<const float> depths) {
    if (options.meaning != DepthMeaning::planar || depths.empty()) return {};
    const auto [least, most] = std::ranges::minmax(depths);
    if (!(least >= 0 && least < 1 && most == 1)) return {};
    return "its depths end at exactly 1, as normalised ones do: if they are, give `depth=normalized` with "
           "`near` and `far`, or `depth=hyperbolic` if they are those of a depth buffer";
}

std::optional<std::string> normalized_warning(const DepthOptions &options, std::span<const float> depths,
                                              const Grid &grid) {
    if (options.meaning == DepthMeaning::planar && looks_white_near(grid, depths) &&
        !are_inverse(grid, depths)) // which has another warning
        return "its depths lie from 0 to 1 and seem to be white near: if they are, give `depth=normalized` "
               "with "
               "`near`, the depth of 0, which is the farther one, and `far`, that of 1";
    return normalized_warning(options, depths);
}

} // namespace sparselens
