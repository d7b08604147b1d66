#include "io/open_packed_view.h"

#include "base/error.h"

#include <algorithm>

namespace sparselens {

namespace {

bool stands_off_centre(const std::vector<float> &offsets) {
    return std::ranges::any_of(offsets, [](float offset) { return offset != 0; });
}

// The view, with the information about its file from an OpenedView or an OpenedLdi.
template <typename Opened>
OpenedPackedView described(PackedView view, Opened &opened) {
    return {std::move(view),
            std::move(opened.header),
            std::move(opened.camera),
            opened.bad,
            opened.depth,
            opened.depth_filtered,
            opened.speckles,
            opened.unpremultiplied,
            std::move(opened.notes),
            std::move(opened.warnings)};
}

} // namespace

OpenedPackedView ready_packed_view(OpenedView opened) {
    return described(PackedView(std::move(opened.view)), opened);
}

OpenedPackedView ready_packed_view(OpenedLdi opened) {
    Ldi &ldi = opened.ldi;
    if (stands_off_centre(ldi.dx) || stands_off_centre(ldi.dy) || !ldi.optical.empty() || !ldi.solid.empty())
        throw Error(opened.name + ": is an LDI, whose samples come from several views: give the views "
                                  "that it was made of, or merge LDIs with ldi-cluster");
    return described(PackedView(opened.name, std::move(ldi)), opened);
}

OpenedPackedView open_packed_view(const std::string &path, const OpenOptions &options,
                                  const Camera &otherwise) {
    return is_deep_alone(path) ? ready_packed_view(open_ldi(path, options))
                               : ready_packed_view(open_view(path, options, otherwise));
}

} // namespace sparselens
