// The command line of ldi-warp.
#pragma once

#include "harness/history.h"
#include "loading/view_list.h"
#include "options/colour_options.h"
#include "options/lens_options.h"
#include "warp/warp.h"

#include <CLI/CLI.hpp>

#include <string>

namespace sparselens {

struct WarpCommand {
    LensOptions lens;
    DepthOptions depth;
    ColourOptions colour;
    HistoryOptions history;
    ViewList views;
    Merge merge = Merge::average;
    bool split_silhouettes = true, test_photo_consistency = true;
    std::string output;
};

void add_warp_options(CLI::App &app, WarpCommand &options);

// Perceptive depth refers to the lens radius if that is known, else to the distance of the outermost view.
WarpOptions warp_options(const WarpCommand &options, const LoadedViews &loaded);

} // namespace sparselens
