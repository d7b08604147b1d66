// The pixels that are gathered, and the LDI that they are gathered from.
#pragma once

#include "../base/subpixels.h"
#include "../deep/highlight_gain.h"
#include "../io/open_ldi.h"
#include "../lens/lens_looks.h"

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
    std::optional<int> supersample =
        {}; // sub-pixels of the LDI, across and down, that become a pixel; else as its file says
    std::optional<PixelFilter> filter = {}; // else as its file says, else a box
};

// As options or the file have it. Throws UsageError where a block of sub-pixels would be cut by the display window, and where views
// were warped for so much larger pixels that the LDI would be another one (kernels/photo_rules.h).
Subpixels subpixels_of(const WindowOptions &options, const OpenedLdi &in);

// The pixels that are gathered, those of them that are needed, and the picture that they become, by `subpixels`. A proxy is made of
// pixels of its own: it has no sub-pixels.
struct GatherWindows {
    Imath::Box2i gathered, needed, picture;
    Subpixels subpixels;
    std::optional<Ldi> changed; // the LDI to gather; empty: the LDI as it was read

    const Ldi &ldi(const OpenedLdi &in) const { return changed ? *changed : in.ldi; }
    // The picture of what was gathered, or of anything else of the pixels that are needed; `nothing`: data of empty sub-pixels.
    Image picture_of(Image needed_pixels, float nothing = 0) const;
};

// Throws UsageError where the pixel to focus on lies outside of the picture, of whose pixels the LDI has `across` sub-pixels to a
// side.
void require_inside(const Imath::V2i &focus_pixel, const OpenedLdi &in, int across);

// Throws Error where there is nothing to gather but depth.
void require_channels(const OpenedLdi &in);

// Whether the LDI to gather has the pixels of the file, whatever they show.
bool keeps_pixels(const WindowOptions &options, const Imf::Header &header);

// Returns the windows of the file, all of them needed; for a proxy, with a copy of the LDI that is as small.
GatherWindows gather_windows(const WindowOptions &options, const OpenedLdi &in);

// The lens of the LDI in the pixels that are gathered.
ThinLens lens_in_gathered(const WindowOptions &options, const OpenedLdi &in, ThinLens lens);

// Pads a copy of the LDI where the blur of a lens of these looks reaches beyond the picture into the display window, if
// OutputOverscan::grow, and chooses the pixels of the picture.
// Throws UsageError where a region or a display window contains no pixel of the picture, and Error where the padded
// picture needs more memory than the LDI justifies (memory_limit.h).
void choose_windows(GatherWindows &frame, const WindowOptions &options, const OpenedLdi &in,
                    const ThinLens &lens, const LensLooks &looks);

// A holdout of the LDI's size, or of that of the picture, whose pixels then hold out all of their sub-pixels; made as small as the
// proxy. Throws Error, naming it, where it has another.
Ldi holdout_for(const OpenedLdi &in, const WindowOptions &options, const Ldi &holdout,
                const std::string &name);

// Brightens the highlights of the LDI to gather. `in` itself stays as it is.
void raise_highlights(GatherWindows &frame, const OpenedLdi &in, const HighlightGain &by);

} // namespace sparselens
