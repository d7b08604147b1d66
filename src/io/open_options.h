// How files are opened.
#pragma once

#include "../view/depth.h"
#include "../view/resolve_lens.h"
#include "exr/picture_choice.h"
#include "usd/film_camera.h"

#include <optional>
#include <string>

namespace sparselens {

struct DepthOptions {
    DepthMeaning meaning = DepthMeaning::planar;
    PictureChoice picture = {};
    // In the unit of the depth channel. Anything at `far` (1e10) or beyond is sky. Both planes are needed if depth is
    // normalized or hyperbolic (see depth_range.h).
    std::optional<double> near = {}, far = {};
};

struct OpenOptions {
    LensValues lens = {}; // empty values come from the file
    DepthOptions depth = {};
    std::optional<FilmCamera> camera = {}; // instead of the camera of the file
};

} // namespace sparselens
