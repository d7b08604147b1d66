// The pixels that a tool makes, and their size.
#pragma once

#include "lens/thin_lens.h"
#include "loading/ldi_cache.h"

#include <CLI/CLI.hpp>

#include <optional>

namespace sparselens {

enum class OutputOverscan {
    keep, // the pixels of the file
    grow, // also those of the display window that the blur reaches; around the data window there is nothing
    crop, // those in the display window
};

struct WindowOptions {
    OutputOverscan overscan = OutputOverscan::keep;
    int proxy = 1;                      // this number of pixels, across and down, becomes one
    std::optional<Imath::Box2i> region; // in the full-size picture
};

void add_window_options(CLI::App &app, WindowOptions &options);

// The pixels that are gathered, and those of them that are written.
struct GatherWindows {
    Imath::Box2i gathered, written;
    std::optional<Ldi> changed; // the LDI to gather; empty: the LDI as it was read
};

// Scales `lens` and a copy of the LDI down to the proxy, and pads the copy if --overscan=grow.
// Throws UsageError where a region or a display window contains no pixel of the picture, and Error where the padded
// picture needs more memory than the LDI justifies (memory_limit.h).
GatherWindows gather_windows(const WindowOptions &options, const InputLdi &in, ThinLens &lens);

} // namespace sparselens
