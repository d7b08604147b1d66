// Opens the views of a command line and positions each on the lens.
#pragma once

#include "deep/packed_view.h"
#include "io/open_view.h"
#include "options/view_list.h"

#include <vector>

namespace sparselens {

struct OpenedViews {
    std::vector<PackedView> views; // the centre view first
    Imf::Header header;            // of the centre view
    Camera camera;               // of the centre view, with the options over it; the lens points of all views
    bool depth_filtered = false; // of the centre view, see SettledEdges
    bool unpremultiplied = false;                          // the same: its colours seem to be
    std::vector<InvalidValues> bad;                        // of each view
    std::vector<std::vector<std::string>> notes, warnings; // of each view, see OpenedView
};

// The position of a view comes from --view, else from worldToCamera (see position_on_lens, whose errors are thrown).
// Its framing comes from its metadata, else it is that of the centre view.
OpenedViews open_views(const ViewList &list, const OpenOptions &options);

} // namespace sparselens
