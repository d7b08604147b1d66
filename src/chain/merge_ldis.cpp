#include "chain/merge_ldis.h"

#include "base/error.h"
#include "deep/merge.h"
#include "deep/tidy.h"
#include "view/place_views.h"

#include <fmt/format.h>

#include <cmath>

namespace sparselens {

namespace {

void require_one_camera(const OpenedLdi &first, const OpenedLdi &other) {
    if (other.ldi.windows.display != first.ldi.windows.display)
        throw Error(fmt::format("{}: its display window differs from that of {}; merge pictures of one size",
                                other.name, first.name));
    require_same_subpixels(first.camera, first.name, other.camera, other.name);
    const int width = first.ldi.windows.display_width();
    const auto focal = focal_length_px(first.camera, width), others = focal_length_px(other.camera, width);
    constexpr double rounding = 1e-3; // relative, of values that other programs have written
    if (focal && others && std::abs(*others / *focal - 1) > rounding)
        throw Error(
            fmt::format("{}: its focal length is {:g} pixels, that of {} is {:g}; merge pictures of one "
                        "camera, or give `focal_length` and `sensor_width`",
                        other.name, *others, first.name, *focal));
}

} // namespace

OpenedLdi merge_ldis(std::vector<OpenedLdi> parts) {
    OpenedLdi first = std::move(parts.front());
    if (parts.size() == 1) return first;
    std::vector<Ldi> ldis;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        require_one_camera(first, parts[i]);
        first.invisible += parts[i].invisible;
        ldis.push_back(std::move(parts[i].ldi));
    }
    ldis.insert(ldis.begin(), std::move(first.ldi));
    first.ldi = tidy(deep_merge(ldis));
    return first;
}

} // namespace sparselens
