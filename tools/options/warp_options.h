// The command line of ldi-warp; and the camera of a layer of USD, for ldi-plan as well.
#pragma once

#include "chain/make_ldi.h"
#include "chain/stated_camera.h"
#include "harness/commands/cli.h"
#include "harness/history.h"
#include "options/picture_options.h"

#include <string>

namespace sparselens {

// The views on a command line: CENTER.exr [VIEW.exr ...] [--view X,Y VIEW.exr]...
struct ViewList {
    std::vector<std::string> files;                          // the centre view first
    std::vector<std::pair<std::string, std::string>> placed; // "X,Y" and a file
};

void add_view_list(CLI::App &app, ViewList &list);

struct WarpCommand : LdiFromViews {
    HistoryOptions history = {};
    ViewList views = {}; // files and positions
    std::string output = {};
    AskedCompression compression = {};
};

void add_warp_options(CLI::App &app, WarpCommand &options);

// --camera, --camera-name and --camera-frame. `camera` must not move until the command line is parsed.
void add_camera_options(CLI::App &app, CameraRequest &camera);

} // namespace sparselens
