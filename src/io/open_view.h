// A rendered view from a file, ready for use: depth is planar, invalid values are repaired, and the camera comes from
// the file, overridden by the user's values.
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
    View view; // at the origin: the caller knows its position
    Imf::Header header;
    Camera camera;                                      // of the header, overridden by the user's values
    InvalidValues bad;                                  // what was repaired
    DepthMeaning depth = DepthMeaning::planar;          // how the file's depths were read
    bool depth_filtered = false;                        // see SettledEdges
    std::size_t speckles = 0;                           // depths of speckles replaced (view/speckles.h)
    bool unpremultiplied = false;                       // whether its colours seem to be so
    std::vector<std::string> notes = {}, warnings = {}; // see FlatFile

    // Throws UsageError if a value of the lens is unknown (see resolve_lens.h).
    ThinLens lens() const { return resolve_lens(camera, view.image.windows); }
};

// Opens a flat EXR with a depth channel; `-` is standard input. Ray lengths need the frustum; if the file lacks it, it
// is taken from `otherwise`. Throws Error if the file cannot be read, or most of its depths are invalid (see
// sanitize()). Throws UsageError if its depth is the length of the ray and the focal length is unknown.
OpenedView open_view(const std::string &path, const OpenOptions &options = {}, const Camera &otherwise = {});

// The same for a picture that is already in memory; `path` is for messages.
OpenedView ready_view(FlatFile file, const std::string &path, const OpenOptions &options = {},
                      const Camera &otherwise = {});

} // namespace sparselens
