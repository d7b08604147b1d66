// The views of a lens as a command line names them: VIEW.exr, whose camera is in its metadata, and
// --view X,Y VIEW.exr, moved X right and Y up of the lens centre (scene units).
#pragma once

#include "harness/commands/cli.h"
#include "io/exr/picture_choice.h"

#include <string>
#include <utility>
#include <vector>

namespace sparselens {

struct LensViewOptions {
    std::vector<std::string> files;
    std::vector<std::pair<std::string, std::string>> placed; // "X,Y" and file
    std::string centre;                                      // a file whose camera stands at the lens centre
    PictureChoice picture;                                   // of each file
};

void add_lens_view_options(CLI::App &app, LensViewOptions &options);

} // namespace sparselens
