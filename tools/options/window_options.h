// Which pixels a tool makes, and at which size.
#pragma once

#include "lens/thin_lens.h"
#include "loading/ldi_cache.h"

#include <CLI/CLI.hpp>

#include <optional>

namespace sparselens {

enum class OutputOverscan {
    keep, // the pixels of the file
    grow, // and into the display window as far as the blur of what is there reaches: around it is nothing
    crop, // those in the display window
};

struct WindowOptions {
    OutputOverscan overscan = OutputOverscan::keep;
    int proxy = 1;                      // so many pixels, across and down, become one
    std::optional<Imath::Box2i> region; // of the full-size picture
};

void add_window_options(CLI::App &app, WindowOptions &options);

// What is gathered, and which part of it is written.
struct GatherWindows {
    Imath::Box2i gathered, written;
    std::optional<Ldi> changed; // of which; none: the LDI as it was
};

// Makes the lens, and of the LDI a copy, that of the proxy; the copy is grown where asked.
// UsageError: a region or a display window that holds no pixel of the picture. Error: a picture grown beyond what the
// memory of the LDI justifies (memory_limit.h).
GatherWindows gather_windows(const WindowOptions &options, const InputLdi &in, ThinLens &lens);

} // namespace sparselens
