// The command line of dof-gather.
#pragma once

#include "chain/take_picture.h"
#include "harness/commands/cli.h"
#include "harness/history.h"
#include "options/picture_options.h"

#include <optional>
#include <string>

namespace sparselens {

struct GatherCommand : PictureRequest {
    HistoryOptions history = {};
    std::string output = {}, depth_output = {};
    std::optional<PixelType> type = {}; // -d
    AskedCompression compression = {};
    int tiles = 0; // side in pixels; 0: scanlines
};

// `options` must not move until the command line is parsed. Parsing throws if options contradict each other.
void add_gather_options(CLI::App &app, GatherCommand &options);

// Adds only the options that decide which picture is made from which file, not what is written where. Other programs
// that show pictures use these.
void add_picture_making_options(CLI::App &app, GatherCommand &options);

} // namespace sparselens
