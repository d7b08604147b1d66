// The command line of dof-gather.
#pragma once

#include "chain/take_picture.h"
#include "harness/commands/cli.h"
#include "harness/history.h"
#include "options/lens_options.h"
#include "options/picture_options.h"

#include <optional>
#include <string>

namespace sparselens {

struct GatherCommand : PictureRequest {
    HistoryOptions history = {};
    std::string output = {}, depth_output = {};
    std::optional<PixelType> type = {}; // -d
    AskedCompression compression = {};
    int tiles = 0; // pixels to a side; 0: scanlines
};

// `options` must stay where it is until the command line is parsed, which throws where options contradict each other.
void add_gather_options(CLI::App &app, GatherCommand &options);

// Those of them that say which picture is made of what, and not what is written where: what else shows pictures has these.
void add_picture_making_options(CLI::App &app, GatherCommand &options);

} // namespace sparselens
