// The lens gather looks at the layered picture through each point of the lens separately. Occlusion is decided at each
// lens point, and the cost does not grow with the area of the blur.
//
// It works on tiles. A tile that no sample with a CoC of half a pixel or more can reach is the flattened LDI. Other
// tiles take as many lens points as their blur and contrast need.
#pragma once

#include "../../base/image.h"
#include "../../base/progress.h"
#include "../../deep/ldi.h"
#include "../../deep/merge.h"
#include "../../lens/lens_looks.h"
#include "../../lens/lens_points.h"
#include "../../lens/thin_lens.h"
#include "../../shutter/lamp_paths.h"

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// How many lens points the lens gather chose for each tile of its window.
inline constexpr int lens_tile_size = 64; // pixels wide and high: what a lens point sees stays in the cache

struct LensTiles {
    int size = lens_tile_size;    // pixels wide and high; less at the right and lower edge
    int columns = 0, rows = 0;    // from the window's upper left corner
    std::vector<int> lens_points; // [row][column]; 0: nothing is out of focus, the flattened LDI is copied
};

// The number of tiles for each number of lens points.
inline std::map<int, int> histogram(const LensTiles &tiles) {
    std::map<int, int> result;
    for (const int points : tiles.lens_points) ++result[points];
    return result;
}

class TileDevice;   // dof/device/tile_device.h
struct GatherScene; // dof/lens/gather_scene.h

enum class Quality { draft, normal, final };

// Observer. Tiles are computed from the pixel `from` (EXR coordinates) outwards. `made` is called after each tile, from
// several threads, but not for tiles in focus or made by a device.
struct TileWatch {
    Imath::V2i from;
    // Other pixels of the picture may change meanwhile.
    std::function<void(const Image &picture, const Imath::Box2i &tile)> made;
};

struct LensGatherOptions {
    Quality quality = Quality::normal;
    int lens_samples = 0; // points in every tile; 0: by the quality and what the tile needs
    LensShare share = {}; // of these points, for one moment of a shutter
    // If given, the highlights (highlights.h) are added to it as parts of lamps, and the picture stays black.
    std::vector<LampPart> *lamps = nullptr;
    const LampPaths *paths = nullptr; // if given, the paths along which the light of lamps is spread
    // If given, only this point of the lens is used, x right, y up, [-1, 1]. Lamps stay as they are, nothing is
    // sharpened, fillers (areas that no view saw) are tinted magenta, and unknown areas stay black.
    std::optional<Imath::V2d> point = {};
    int across = 1; // pixels, across and down, that become one of the picture (base/subpixels.h)
    LensLooks looks = {};
    LensTiles *chosen = nullptr;             // if given, receives the chosen tiles
    std::optional<Imath::Box2i> region = {}; // only its tiles are gathered; the others stay in focus
    // Pixels that are transparent to infinity if they are empty; not set: the window. The pixels marked in `unseen`,
    // [pixel of the data window], are excepted.
    std::optional<Imath::Box2i> known = {};
    std::span<const char> unseen = {};
    std::optional<Imath::Box2i> seen = {}; // pixels that were seen, not made up beyond the frame; else all
    bool keeps_sums = false; // sums of channels: in tiles gathered in cells, each may leave its range
    const Holdout *holdout = nullptr; // hides the picture behind it
    const TileWatch *watch = nullptr; // if given
    TileDevice *device = nullptr;     // if given, gathers the tiles that it can
};

// Gathers the pixels `window` (EXR coordinates, within the LDI's data window), with the channels of the LDI. An empty
// pixel in `window`, or in `known`, is transparent to infinity; outside, nothing is known. Ids are those of the front
// samples. The LDI must be tidy, and the lens radius above 0, or 0 if the looks magnify.
Image lens_gather(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  const LensGatherOptions &options, Progress &progress);

// The steps of lens_gather(), for callers that gather repeatedly (only if R, G and B share one focus): the flattened
// LDI, which does not depend on lens and looks; prepare() (dof/lens/gather_scene.h); and gather_tiles(), which replaces
// the tiles of `picture` that are out of focus. The work ends if a listener of `progress` throws.
Image in_focus_everywhere(const Ldi &ldi, const Imath::Box2i &window, const LensGatherOptions &options);
void gather_tiles(const GatherScene &scene, const LensGatherOptions &options, Progress &progress,
                  Image &picture);

} // namespace sparselens
