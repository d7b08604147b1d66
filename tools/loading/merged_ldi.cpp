#include "loading/merged_ldi.h"

#include "base/error.h"
#include "deep/merge.h"
#include "deep/tidy.h"
#include "loading/notices.h"

#include <fmt/format.h>

#include <cmath>

namespace sparselens {

namespace {

OpenedLdi open_one(const std::string &path, const OpenOptions &options, const ToolContext &tool) {
    OpenedLdi in = open_ldi(path, options);
    say_samples(tool, in);
    warn_of_invalid_values(tool, path, in.bad);
    return in;
}

void require_one_camera(const OpenedLdi &first, const OpenedLdi &other) {
    if (other.ldi.windows.display != first.ldi.windows.display)
        throw Error(fmt::format("{}: its display window differs from that of {}; merge pictures of one size",
                                other.name, first.name));
    const int width = first.ldi.windows.display_width();
    const auto focal = focal_length_px(first.camera, width), others = focal_length_px(other.camera, width);
    constexpr double rounding = 1e-3; // relative, of values that other programs have written
    if (focal && others && std::abs(*others / *focal - 1) > rounding)
        throw Error(
            fmt::format("{}: its focal length is {:g} pixels, that of {} is {:g}; merge pictures of one "
                        "camera, or give --focal-length and --sensor-width",
                        other.name, *others, first.name, *focal));
}

} // namespace

OpenedLdi open_merged(const std::vector<std::string> &paths, const OpenOptions &options,
                      const ToolContext &tool) {
    OpenedLdi first = open_one(paths.front(), options, tool);
    if (paths.size() == 1) return first;
    std::vector<Ldi> parts;
    for (std::size_t i = 1; i < paths.size(); ++i) {
        OpenedLdi other = open_one(paths[i], options, tool);
        require_one_camera(first, other);
        first.invisible += other.invisible;
        parts.push_back(std::move(other.ldi));
    }
    parts.insert(parts.begin(), std::move(first.ldi));
    first.ldi = tidy(deep_merge(parts));
    return first;
}

} // namespace sparselens
