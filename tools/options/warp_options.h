// The command line of ldi-warp.
#pragma once

#include "chain/make_ldi.h"
#include "harness/commands/cli.h"
#include "harness/history.h"
#include "options/parameter_options.h"
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

} // namespace sparselens
