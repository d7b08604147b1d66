// How files are opened.
#pragma once

#include "../view/depth.h"
#include "../view/resolve_lens.h"
#include "exr/picture_choice.h"

#include <optional>
#include <string>

namespace sparselens {

struct DepthOptions {
    DepthMeaning meaning = DepthMeaning::planar;
    PictureChoice picture = {};
    // In the unit of the depth channel: what lies at `far` (1e10) or beyond is the sky; both planes are needed where depth
    // is normalized or hyperbolic (see depth_range.h).
    std::optional<double> near = {}, far = {};
};

struct OpenOptions {
    LensValues lens = {}; // what is left out is as the file says
    DepthOptions depth = {};
};

} // namespace sparselens
