// The lens gather: the layered picture seen through each point of the lens separately, so that what hides what
// is decided where it happens, and the cost does not grow with the area of the blur.
//
// Work goes by tiles. A tile that no sample with a CoC of half a pixel or more can reach is the flattened LDI.
// Any other takes as many lens points as its blur and its contrast ask for.
#pragma once

#include "../../base/image.h"
#include "../../base/progress.h"
#include "../../deep/holdout.h"
#include "../../deep/ldi.h"
#include "../../lens/lens_looks.h"
#include "../../lens/thin_lens.h"
#include "lens_tiles.h"

#include <functional>
#include <optional>
#include <span>

namespace sparselens {

class TileDevice;   // dof/device/tile_device.h
struct GatherScene; // dof/lens/gather_scene.h

enum class Quality { draft, normal, final };

// Who looks on: tiles are made from this pixel (EXR coordinates) outwards, and told of when they are made, by several threads at once;
// those that are in focus and those of a device are not.
struct TileWatch {
    Imath::V2i from;
    std::function<void(const Image &picture, const Imath::Box2i &tile)>
        made; // other pixels of the picture may change
};

struct LensGatherOptions {
    Quality quality = Quality::normal;
    int lens_samples = 0; // points in every tile; 0: by the quality and what the tile needs
    // Where given: this point of the lens alone, x right, y up, [-1, 1]. It sees lamps as they are, nothing is sharpened, what no
    // view saw is half magenta (what fillers are), and what nothing is known of stays black.
    std::optional<Imath::V2d> point = {};
    int across = 1; // pixels, across and down, that become one of the picture (base/subpixels.h)
    LensLooks looks = {};
    LensTiles *chosen = nullptr;             // where given: is told what was chosen
    std::optional<Imath::Box2i> region = {}; // tiles beside it stay as they were rendered
    std::optional<Imath::Box2i> known =
        {};                                // pixels of which the empty ones are transparent; else the window;
    std::span<const char> unseen = {};     // [pixel of the data window] but for these
    std::optional<Imath::Box2i> seen = {}; // pixels that were seen, not made up beyond the frame; else all
    bool keeps_sums = false; // of channels: where tiles are gathered in cells, each may leave its range
    const Holdout *holdout = nullptr; // holds the picture out
    const TileWatch *watch = nullptr; // where given
    TileDevice *device = nullptr;     // where given: gathers the tiles that it can
};

// Pixels `window` (EXR coordinates, within the LDI's data window), channels of the LDI. In `window`, or `known`, an empty
// pixel is transparent to infinity; outside of it, nothing is known. Ids are the front samples'. The LDI is tidy,
// the lens radius above 0, or 0 where the looks magnify.
Image lens_gather(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  const LensGatherOptions &options, Progress &progress);

// Its steps, for who gathers again and again (but of R, G and B alike): the flattened LDI, which no lens and no look changes; all that
// tiles are gathered from, by prepare() (dof/lens/gather_scene.h); and the tiles that are out of focus, in place of those
// of `picture`. A listener of `progress` that throws ends the work.
Image in_focus_everywhere(const Ldi &ldi, const Imath::Box2i &window, const LensGatherOptions &options);
void gather_tiles(const GatherScene &scene, const LensGatherOptions &options, Progress &progress,
                  Image &picture);

} // namespace sparselens
