// The pixels that are gathered, and the LDI that they are gathered from.
#pragma once

#include "io/open_ldi.h"
#include "options/window_options.h"

#include <optional>

namespace sparselens {

// The pixels that are gathered, and those of them that are written.
struct GatherWindows {
    Imath::Box2i gathered, written;
    std::optional<Ldi> changed; // the LDI to gather; empty: the LDI as it was read
};

// Scales `lens` and a copy of the LDI down to the proxy, and pads the copy where the blur reaches beyond the picture
// into the display window, if --overscan=grow.
// Throws UsageError where a region or a display window contains no pixel of the picture, and Error where the padded
// picture needs more memory than the LDI justifies (memory_limit.h).
GatherWindows gather_windows(const WindowOptions &options, const OpenedLdi &in, ThinLens &lens);

} // namespace sparselens
