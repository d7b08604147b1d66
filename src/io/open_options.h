// How files are opened.
#pragma once

#include "../view/depth.h"
#include "../view/resolve_lens.h"

#include <string>

namespace sparselens {

struct DepthOptions {
    DepthMeaning meaning = DepthMeaning::planar;
    std::string channel = {}; // empty: Z, depth.Z and *.Depth.Z are tried
    std::string view = {};    // of a stereo file; empty: the default one
    double far = 1e10;        // what lies there or beyond is the sky, in the unit of the depth channel
};

struct OpenOptions {
    LensValues lens = {}; // what is left out is as the file says
    DepthOptions depth = {};
};

} // namespace sparselens
