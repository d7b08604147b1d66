// The command line of ldi-warp.
#pragma once

#include "chain/make_ldi.h"
#include "harness/commands/cli.h"
#include "harness/history.h"
#include "options/colour_options.h"
#include "options/lens_options.h"
#include "options/picture_options.h"
#include "options/view_list.h"

#include <string>

namespace sparselens {

struct WarpCommand : LdiFromViews {
    HistoryOptions history = {};
    ViewList views = {}; // its files, and where they stood
    std::string output = {};
    AskedCompression compression = {};
};

void add_warp_options(CLI::App &app, WarpCommand &options);

} // namespace sparselens
