// How the tools load what they work on: depth made planar, camera and lens put together.
//
// A depth of 0 says that nothing was hit, as many renderers write it: it becomes infinity, as does any depth where
// A is 0. Error (naming file and pixel) where another depth is no number above 0.
#pragma once

#include "common/lens_options.h"
#include "io/exr_deep.h"
#include "ldi/ldi.h"
#include "view/view.h"

#include <ImfHeader.h>

#include <string>

namespace sparselens {

struct LoadedLdi {
    Ldi ldi; // tidy
    Imf::Header header;
    Camera camera; // of the header, with the options over it
};

LoadedLdi load_ldi(const std::string &path, const LensOptions &lens, const DepthOptions &depth);

struct LoadedView {
    View view; // at the origin: the caller knows where it stands
    Imf::Header header;
    Camera camera; // of the header alone
};

LoadedView load_view(const std::string &path, const LensOptions &lens, const DepthOptions &depth);

} // namespace sparselens
