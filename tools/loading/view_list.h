// The views on a command line: CENTER.exr [VIEW.exr ...] [--view X,Y VIEW.exr]...
#pragma once

#include "loading/pictures.h"

#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

namespace sparselens {

struct ViewList {
    std::vector<std::string> files;                          // the centre view first
    std::vector<std::pair<std::string, std::string>> placed; // "X,Y" and a file
};

void add_view_list(CLI::App &app, ViewList &list);

struct LoadedViews {
    std::vector<View> views; // the centre view first
    Imf::Header header;      // of the centre view
    Camera camera;           // of the centre view, with the options over it; the lens points of all views
    std::vector<InvalidValues> bad; // of each view
};

// A view's position comes from --view, else from worldToCamera (see position_on_lens, whose errors it throws); its framing
// from its metadata, else it is the centre view's.
LoadedViews load_views(const ViewList &list, const LensOptions &lens, const DepthOptions &depth);

} // namespace sparselens
