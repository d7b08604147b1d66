// A view from a file, flat or deep, ready for the warp.
#pragma once

#include "deep/view_samples.h"
#include "io/open_ldi.h"
#include "io/open_view.h"

#include <string>
#include <vector>

namespace sparselens {

// As in OpenedView and OpenedLdi; a deep file's depth is not filtered.
struct OpenedPackedView {
    PackedView view; // at the origin
    Imf::Header header;
    Camera camera;
    InvalidValues bad;
    DepthMeaning depth = DepthMeaning::planar;
    bool depth_filtered = false;
    std::size_t speckles = 0;
    bool unpremultiplied = false;
    std::vector<std::string> notes = {}, warnings = {};
};

// Throws as open_view() does; for a file of deep parts alone, as open_ldi() and ready_packed_view() do.
OpenedPackedView open_packed_view(const std::string &path, const OpenOptions &options = {},
                                  const Camera &otherwise = {});

OpenedPackedView ready_packed_view(OpenedView view);
// Throws Error if the picture was made from several views, and so is not a view of one camera.
OpenedPackedView ready_packed_view(OpenedLdi ldi);

} // namespace sparselens
