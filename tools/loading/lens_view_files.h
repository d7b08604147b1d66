// The views of a lens that a command line names, each at its position on the lens.
#pragma once

#include "io/exr/exr_flat.h"
#include "options/lens_view_options.h"
#include "view/lens_views.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct LensViewFile {
    std::string path;
    Imath::V2d position;    // on the lens: relative to its centre, scene units, x right, y up
    Imath::V2d shift{0, 0}; // from the point where its optical axis meets the picture to the centre's, pixels
    std::optional<FlatFile> pixels; // already read: standard input gives them only once
    std::string stereo_view;        // of the file
    FlatFile take_pixels();         // reads them where they are not
};

struct LensViewFiles {
    std::vector<LensViewFile> views; // not empty
    Imf::Header header;              // of the centre's file where one is named, else of the first view
    Windows windows;                 // of the first view
    Camera centre;                   // what is known of the camera at the lens centre
    bool centre_guessed = false;     // see LensViews
};

// Reads the headers. UsageError: no views, a malformed X,Y, a view that cannot be placed. Error: display
// windows that differ, views that do not lie in one plane (require_one_plane).
LensViewFiles open_lens_views(const LensViewOptions &options);

} // namespace sparselens
