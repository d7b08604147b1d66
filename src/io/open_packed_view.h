// A view from a file, flat or deep, ready for the warp.
#pragma once

#include "deep/packed_view.h"
#include "io/open_ldi.h"
#include "io/open_view.h"

#include <string>
#include <vector>

namespace sparselens {

// As OpenedView and OpenedLdi; a deep file's depth is not filtered.
struct OpenedPackedView {
    PackedView view; // at the origin
    Imf::Header header;
    Camera camera;
    InvalidValues bad;
    DepthMeaning depth = DepthMeaning::planar;
    bool depth_filtered = false, unpremultiplied = false;
    std::vector<std::string> notes = {}, warnings = {};
};

// Throws as open_view(), or of a file that holds deep parts alone as open_ldi() and ready_packed_view().
OpenedPackedView open_packed_view(const std::string &path, const OpenOptions &options = {},
                                  const Camera &otherwise = {});

OpenedPackedView ready_packed_view(OpenedView view);
// Throws Error where the picture was made of several views, and is no view of one camera.
OpenedPackedView ready_packed_view(OpenedLdi ldi);

} // namespace sparselens
