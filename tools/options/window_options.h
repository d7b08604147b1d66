// The pixels that a tool makes, and their size.
#pragma once

#include "harness/commands/cli.h"

#include <Imath/ImathBox.h>

#include <optional>

namespace sparselens {

enum class OutputOverscan {
    grow, // those of the file and those of the display window that the blur reaches; around the data window is nothing
    keep, // those of the file
    crop, // those of the file that lie in the display window
};

struct WindowOptions {
    OutputOverscan overscan = OutputOverscan::grow;
    int proxy = 1;                      // this number of pixels, across and down, becomes one
    std::optional<Imath::Box2i> region; // in the full-size picture
};

void add_window_options(CLI::App &app, WindowOptions &options);

} // namespace sparselens
