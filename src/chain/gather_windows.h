// The pixels that are gathered, and the LDI from which they are gathered.
#pragma once

#include "../base/kept.h"
#include "../base/subpixels.h"
#include "../deep/checks/flicker.h"
#include "../deep/recolor.h"
#include "../io/open_ldi.h"
#include "../lens/lens_looks.h"
#include "colours.h"

#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace sparselens {

enum class OutputOverscan {
    grow, // the file's pixels, and those of the display window that the blur reaches; what lies beyond them is empty
    keep, // the file's pixels
    crop, // the file's pixels in the display window
};

// The pixels that a picture shall have, and its size.
struct WindowOptions {
    OutputOverscan overscan = OutputOverscan::grow;
    int proxy = 1;                           // this many pixels, across and down, become one
    std::optional<Imath::Box2i> region = {}; // in the full-size picture
    std::optional<int> supersample =
        {}; // sub-pixels of the LDI, across and down, per pixel; default: as in its file
    std::optional<PixelFilter> filter = {}; // default: as in its file, or else a box
    bool joins_subpixels = false; // first makes one sample of a surface's samples in a pixel: a draft
};

// The sub-pixels, from the options or the file. Throws UsageError if the display window would cut a block of
// sub-pixels, or if the views were warped for so much smaller pixels that the LDI would be different (motion_unit() in
// kernels/warp_rules.h).
Subpixels subpixels_of(const WindowOptions &options, const OpenedLdi &in);

// The pixels to gather, the needed ones among them, and the picture that they become, by `subpixels`. A proxy, or a
// picture whose sub-pixels are joined, consists of its own pixels and has no sub-pixels.
struct GatherWindows {
    Imath::Box2i gathered, needed, picture;
    Subpixels subpixels;
    std::optional<Ldi> changed; // the LDI to gather; empty: the LDI as it was read

    const Ldi &ldi(const OpenedLdi &in) const { return changed ? *changed : in.ldi; }
    // The picture made of gathered pixels, or of other values of the needed pixels; `nothing`: the data of empty
    // sub-pixels.
    Image picture_of(Image needed_pixels, float nothing = 0) const;
};

// Throws UsageError if the pixel to focus on lies outside of the picture. Each of the picture's pixels has `across`
// sub-pixels to a side in the LDI.
void require_inside(const Imath::V2i &focus_pixel, const OpenedLdi &in, int across);

// Throws Error if the LDI has nothing to gather but depth.
void require_channels(const OpenedLdi &in);

// Whether the LDI to gather keeps the pixels of the file, whatever they show. `camera`: of the file.
bool keeps_pixels(const WindowOptions &options, const Imf::Header &header, const Camera &camera);

// Returns the windows of the file, all needed; for a smaller picture, with an LDI reduced to its size.
GatherWindows gather_windows(const WindowOptions &options, const OpenedLdi &in);

// The lens of the LDI in the pixels that are gathered.
ThinLens lens_in_gathered(const WindowOptions &options, const OpenedLdi &in, ThinLens lens);

// If OutputOverscan::grow is set, pads a copy of the LDI where the blur of a lens of these looks reaches beyond the
// picture into the display window. Chooses the pixels of the picture. Throws UsageError if a region or a display window
// contains no pixel of the picture, and Error if the padded picture needs more memory than the LDI justifies
// (memory_limit.h).
void choose_windows(GatherWindows &frame, const WindowOptions &options, const OpenedLdi &in,
                    const ThinLens &lens, const LensLooks &looks);

// A holdout of the LDI's size, or of the picture's size, whose pixels then hold out all of their sub-pixels; it is
// reduced like a proxy. Throws Error, naming it, if it has another size.
Ldi holdout_for(const OpenedLdi &in, const WindowOptions &options, const Ldi &holdout,
                const std::string &name);

// Brightens the highlights of the LDI to gather. `in` itself stays as it is.
void raise_highlights(GatherWindows &frame, const OpenedLdi &in, const HighlightGain &by);

// Opens the LDI of a picture and keeps the last one, so that pulling focus over one file reads it only once.

// A file with samples, and what to read from it.
struct LdiRequest {
    std::string input = {}, recolor = {}; // `recolor`: the flat picture with its colours, or ""
    std::string channels = {};            // comma-separated (channels.h); empty: all
    LensValues lens = {};                 // override the file's values
    DepthOptions depth = {};
    ColourOptions colour = {};
};

class LdiCache {
public:
    // `of_sequence`: the disparities of all photographs are scaled as those of the first, which also has the focus of all.
    explicit LdiCache(bool of_sequence = false) : of_sequence_(of_sequence) {}

    // Opens, recolours and makes linear the requested file, if the last file was another, was read with other options,
    // or has been used up since. Channels that are not requested are left out. The camera is that of the file alone,
    // without `lens`. Earlier results become invalid.
    OpenedLdi &load(const LdiRequest &request, const Notify &notify, const ChooseSamples &choose = {});

    // Whether the last load() read the file, and which of its channels were left out.
    bool read_now() const { return read_now_; }
    const std::vector<std::string> &channels_left_out() const { return channels_left_out_; }

private:
    // Everything that the samples depend on. The focal length is part of it, because it makes ray lengths planar.
    using Key = std::tuple<std::string, std::string, std::string, DepthOptions, std::optional<double>,
                           std::optional<double>, std::string, std::string>;
    Kept<Key, OpenedLdi> kept_{1};
    bool read_now_ = false;
    std::vector<std::string> channels_left_out_;
    Flicker flicker_;
    bool of_sequence_;
    std::optional<DisparityRange> disparities_; // of its first photograph
    std::optional<PixelInFocus> focus_;
};

} // namespace sparselens
