// The pixels that are gathered, and the LDI that they are gathered from.
#pragma once

#include "../dof/highlight_gain.h"
#include "../lens/lens_looks.h"
#include "open_ldi.h"

#include <optional>

namespace sparselens {

enum class OutputOverscan {
    grow, // those of the file and those of the display window that the blur reaches; around the data window is nothing
    keep, // those of the file
    crop, // those of the file that lie in the display window
};

// Which pixels a picture is to have, and its size.
struct WindowOptions {
    OutputOverscan overscan = OutputOverscan::grow;
    int proxy = 1;                           // this number of pixels, across and down, becomes one
    std::optional<Imath::Box2i> region = {}; // in the full-size picture
};

// The pixels that are gathered, and those of them that are written.
struct GatherWindows {
    Imath::Box2i gathered, written;
    std::optional<Ldi> changed; // the LDI to gather; empty: the LDI as it was read

    const Ldi &ldi(const OpenedLdi &in) const { return changed ? *changed : in.ldi; }
};

// Those of the file, all of them written. Scales `lens` and a copy of the LDI down to the proxy.
GatherWindows gather_windows(const WindowOptions &options, const OpenedLdi &in, ThinLens &lens);

// Pads a copy of the LDI where the blur of a lens of these looks reaches beyond the picture into the display window, if
// --overscan=grow, and chooses the pixels that are written.
// Throws UsageError where a region or a display window contains no pixel of the picture, and Error where the padded
// picture needs more memory than the LDI justifies (memory_limit.h).
void choose_windows(GatherWindows &frame, const WindowOptions &options, const OpenedLdi &in,
                    const ThinLens &lens, const LensLooks &looks);

// Brightens the highlights of the LDI to gather. `in` itself stays as it is.
void raise_highlights(GatherWindows &frame, const OpenedLdi &in, const HighlightGain &by);

} // namespace sparselens
