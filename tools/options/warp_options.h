// The command line of ldi-warp.
#pragma once

#include "harness/commands/cli.h"
#include "harness/history.h"
#include "options/colour_options.h"
#include "options/lens_options.h"
#include "options/picture_options.h"
#include "options/view_list.h"
#include "warp/warp.h"

#include <string>

namespace sparselens {

struct WarpCommand {
    LensValues lens;
    DepthOptions depth;
    ColourOptions colour;
    HistoryOptions history;
    ViewList views;
    std::vector<std::string> denoised; // of all views, in their order; or none
    std::string noisy; // the layer of the views as they were before they were denoised; empty: none
    Merge merge = Merge::average;
    bool split_silhouettes = true, test_photo_consistency = true, find_images = true, round_for_lens = false;
    std::string output;
    std::string device = "cpu"; // as choose_device() has it
    AskedCompression compression;
};

void add_warp_options(CLI::App &app, WarpCommand &options);

} // namespace sparselens
