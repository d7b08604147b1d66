// Views through a lens that a command line names: VIEW.exr with its camera in the metadata, and --view X,Y VIEW.exr,
// moved X right and Y up from the lens centre (scene units). Finds the position of each view on the lens.
#pragma once

#include "io/exr/exr_flat.h"
#include "view/lens_views.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sparselens {

struct LensViewOptions {
    std::vector<std::string> files;
    std::vector<std::pair<std::string, std::string>> placed; // "X,Y" and file
    std::string centre;                                      // a file rendered from the lens centre
    PictureChoice picture;                                   // of each file
};

struct LensViewFile {
    std::string path;
    Imath::V2d position;    // on the lens: relative to its centre, scene units, x right, y up
    Imath::V2d shift{0, 0}; // from the point where its optical axis meets the picture to the centre's, pixels
    std::optional<FlatFile> pixels; // set if already read: standard input can be read only once
    PictureChoice picture;          // of the file
    FlatFile take_pixels();         // reads them if needed
};

struct LensViewFiles {
    std::vector<LensViewFile> views; // not empty
    Imf::Header header;              // of the centre's file if one is given, else of the first view
    Windows windows;                 // of the first view
    Camera centre;                   // known properties of the camera at the lens centre
    bool centre_guessed = false;     // see LensViews
};

// Reads the headers. Throws UsageError if there are no views, an X,Y is malformed or the position of a view is unknown,
// and Error if display windows differ or the views do not lie in one plane (require_one_plane).
LensViewFiles open_lens_views(const LensViewOptions &options);

} // namespace sparselens
