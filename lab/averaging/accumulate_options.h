// The command line of dof-accumulate.
#pragma once

#include "harness/commands/cli.h"
#include "harness/history.h"
#include "lab/averaging/lens_view_files.h"
#include "options/picture_options.h"

#include <optional>
#include <string>

namespace sparselens {

struct AccumulateOptions {
    LensViewOptions views;
    LensValues lens;
    HistoryOptions history;
    std::string output;
    std::optional<PixelType> type; // -d
    AskedCompression compression;
    bool transparent_outside = false;
};

void add_accumulate_options(CLI::App &app, AccumulateOptions &options);

} // namespace sparselens
