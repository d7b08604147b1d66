// The methods that make the lens picture from an LDI, by name.
#pragma once

#include "../base/image.h"
#include "../base/progress.h"
#include "../deep/ldi.h"
#include "../lens/thin_lens.h"
#include "lens/lens_gather.h"

#include <optional>
#include <span>

namespace sparselens {

// The options of all methods; each uses its own.
struct GatherOptions {
    int layers = 8;             // selective: the largest number of layers kept apart in a pixel
    LensGatherOptions lens;     // lens: quality, lens points
    double layer_tolerance = 0; // lens: layers of the light that are merged (merge_layers.h), pixels; 0: none
    // Lens: the frame, beyond which surfaces continue (lens/beyond/frame_extension.h), and how far the lens looks
    // there, pixels.
    struct Beyond {
        Imath::Box2i frame;
        Imath::V2i reach;
    };
    std::optional<Beyond> beyond = {}; // else nothing is known there
    // Lens: radius of the lens that the views were rendered with, scene units; 0: the radius of the gathering lens.
    double views_radius = 0;
};

struct GatherMethod {
    using Gather = Image (*)(const Ldi &, const ThinLens &, const Imath::Box2i &window, const GatherOptions &,
                             Progress &);
    const char *name;
    const char *what; // description for users, a few words
    bool on_devices;  // GatherOptions::lens.device may be given
    // Looks through each point of the lens, so that looks, tiles, merged layers, the paths of lamps and what lies beyond
    // the frame work with it.
    bool by_lens_points;
    Gather light; // all channels but Cryptomattes

    // Gathers the pixels of a window (EXR coordinates) within the data window of the LDI: all its channels, each by its
    // own coverage (deep/channel_alpha.h). The lens radius must be above 0.
    Image gather(const Ldi &, const ThinLens &, const Imath::Box2i &window, const GatherOptions &,
                 Progress &) const;
};

// The default method first.
std::span<const GatherMethod> gather_methods();

// Adds a method at the end, for programs with methods of their own. Call it before main only, because pointers to
// methods are kept. Returns true, so that the initialiser of a constant can call it.
bool join_gather_methods(const GatherMethod &);

// Cryptomattes through the lens (base/matte.h): which objects a lens sees in a pixel, and how much of each.
//
// The coverage of one id is gathered as the channel of a picture that shows this object in white and all others in
// black, through the same lens points as the picture itself; then the ids of each pixel are ranked anew.

// Returns the mattes of the LDI in `window`; the channels are the LDI's matte channels. The arguments are those of
// lens_gather().
Image gather_mattes(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const LensGatherOptions &options, Progress &progress);

} // namespace sparselens
