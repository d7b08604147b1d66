// A rendered view from a file, ready for use: depth is planar, invalid values are repaired, and the camera is that of
// the file with the user's values over it.
#pragma once

#include "../deep/sanitize.h"
#include "../view/camera.h"
#include "../view/view.h"
#include "exr/exr_flat.h"
#include "open_options.h"

#include <ImfHeader.h>

#include <string>
#include <vector>

namespace sparselens {

struct OpenedView {
    View view; // at the origin: the caller knows where it stands
    Imf::Header header;
    Camera camera;                                      // of the header, with the user's values over it
    InvalidValues bad;                                  // what was repaired
    DepthMeaning depth = DepthMeaning::planar;          // what the file's depths were read as
    bool depth_filtered = false;                        // see SettledEdges
    bool unpremultiplied = false;                       // its colours seem to be
    std::vector<std::string> notes = {}, warnings = {}; // see FlatFile

    // UsageError: a value of the lens is unknown (see resolve_lens.h).
    ThinLens lens() const { return resolve_lens(camera, view.image.windows); }
};

// Opens a flat EXR with a depth channel; `-` is standard input. What the file does not say of its frustum, which ray
// lengths need, is as in `otherwise`.
// Error: the file cannot be read, or most of its depths are invalid (see sanitize()). UsageError: its depth is the
// length of the ray, and the focal length is unknown.
OpenedView open_view(const std::string &path, const OpenOptions &options = {}, const Camera &otherwise = {});

// The same for a picture that is in memory, or was read otherwise; `path` is for messages.
OpenedView ready_view(FlatFile file, const std::string &path, const OpenOptions &options = {},
                      const Camera &otherwise = {});

} // namespace sparselens
