// Which tiles of a picture are out of focus, and what each of them is gathered from.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/cells.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/lens_gather.h"
#include "dof/lens/sample_blocks.h"
#include "lens/aperture.h"
#include "lens/lens_samples.h"

#include <Imath/ImathVec.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <list>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// The CoCs of the samples that can reach a tile, without their signs, pixels.
struct ReachingCocs {
    // The largest that shows. Backgrounds count only where something opaque hides them.
    float largest = 0;
    // A lower bound of the smallest.
    float least = std::numeric_limits<float>::max();
    bool with_background = false; // whether a background reaches it
};

class BlockFinder {
public:
    // The samples must outlive this.
    BlockFinder(const BlockedSamples &samples, const Aperture &aperture, double pixel_aspect);

    // Finds, in order, the blocks that can reach a tile or the pixels next to it. `stretched`: the largest factor by
    // which lens points are stretched.
    ReachingCocs find(const Imath::V2i &origin, int size, float stretched,
                      std::vector<std::uint32_t> &found) const;
    float extent() const { return extent_; }

private:
    float reach_of(const SampleBlock &block) const;
    // Some consecutive blocks, and how far they reach.
    struct Run {
        std::uint32_t begin, end;
        float x_min, x_max, y_min, y_max, reach;
    };

    const BlockedSamples &samples_;
    float extent_; // of the aperture, pixels per pixel of CoC
    std::vector<Run> runs_;
};

struct TileBlocks {
    std::vector<std::uint32_t> samples, facets, fillers, solids;
};

class SceneBlocks {
public:
    // The scene outlives this.
    explicit SceneBlocks(const GatherScene &scene);

    // Finds the blocks of the tile [origin, origin + size), relative to the data window's corner like the samples.
    // `stretched`: the largest factor by which lens points are stretched.
    ReachingCocs find(const Imath::V2i &origin, int size, float stretched, TileBlocks &found) const;
    float extent() const { return samples_.extent(); } // of the aperture, for each pixel of CoC

private:
    const GatherScene &scene_;
    BlockFinder samples_, fillers_, solids_;
};

// The sets of lens points that tiles choose from. Each is made when it is first asked for, by any thread.
class LensSets {
public:
    // The aperture must outlive this.
    LensSets(const LensGatherOptions &options, const Aperture &aperture, double pixel_aspect)
        : options_(options), aperture_(aperture), pixel_aspect_(pixel_aspect) {}

    // Returns the set for a tile whose largest CoC is `largest` pixels, with the number of points doubled `doubled`
    // times, at most twice.
    const std::vector<LensSample> &for_coc(float largest, std::size_t doubled);

private:
    // The error of a set falls with the number of points and grows with the blur. Measured on fence at 1920x1080
    // against 4096 points: 96 points at 4 pixels of CoC leave 50 dB, 256 points at 64 pixels 46 dB. A sub-pixel takes
    // 3/4 of the points that the CoC in pixels of the picture asks for. Fence and grass at 2 x 640x360 then have 51.6
    // and 48.6 dB; with points by the CoC in sub-pixels, 51.8 and 48.8; with half of the pixel's points, 51.0 and 48.3.
    static constexpr std::array<float, 6> largest_coc{6, 12, 20, 32, 48, INFINITY};
    static constexpr std::array<std::size_t, 6> normal_points{96, 128, 160, 192, 224, 256},
        final_points{288, 384, 480, 576, 896, 1024}; // up to 576 by steps of their own (lens_samples.h)

    LensSample through(const Imath::V2d &point) const;
    std::vector<LensSample> of_share(std::size_t points) const;
    static std::size_t step_for(float coc);
    std::size_t points_of(std::size_t step) const;
    std::size_t of_pixel(std::size_t step) const;

    LensGatherOptions options_;
    const Aperture &aperture_;
    double pixel_aspect_;
    static constexpr std::size_t steps = largest_coc.size();
    std::array<std::once_flag, 3 * steps> made_;
    std::array<std::vector<LensSample>, 3 * steps> sets_;
};

struct PlannedTile {
    std::size_t number; // in the plan
    std::size_t tile;   // of the picture
    Imath::Box2i part;  // of the tile, that is gathered
    Imath::V2i first;   // pixel of the tile, EXR coordinates
    TileBlocks blocks = {};
    std::span<const LensSample> lens = {};
    const GatherScene *scene = nullptr;  // that it is gathered from
    std::optional<TileCells> cells = {}; // set if the scene is a coarse one
    // A coarse scene, in cells of `caster_cells` pixels, that casts the shadows on lamps far behind it; null: none
    const GatherScene *caster_scene = nullptr;
    int caster_cells = 1;
    TileBlocks cell_blocks = {}; // the blocks of the coarse scene
    std::vector<LensSample> bent = {};

    TileTask task() const;
};

class TilePlan {
public:
    // Makes the coarse scenes that tiles ask for. All arguments must outlive this.
    TilePlan(const GatherScene &scene, const LensGatherOptions &options, const Windows &picture);

    const LensTiles &tiles() const { return tiles_; } // none has lens points yet
    std::size_t count() const;                        // tiles of the plan
    // The scenes that tiles are gathered from, the one at full size first.
    std::vector<const GatherScene *> scenes() const;
    // The numbers of the tiles, from the watched pixel outwards if there is a watch.
    std::vector<std::size_t> in_order() const;
    // Returns nothing if the tile is in focus or not asked for, because the flattened LDI is already there; a tile that
    // a lamp's streak reaches is not in focus. May be called by any thread.
    std::optional<PlannedTile> tile(std::size_t number);

private:
    // A scene in cells of `across` pixels, across and down.
    struct Level {
        int across;
        std::optional<GatherScene> coarse;
        const GatherScene &scene;
        SceneBlocks blocks{scene};

        Level(const GatherScene &full, int cells);
        Level(const Level &) = delete;
        Level &operator=(const Level &) = delete;
    };
    // The blur that reaches a tile, pixels.
    struct Blur {
        float largest, least; // CoCs
        float stretched;
        int cells; // size of the cells that it asks for; 1: none
    };
    PlannedTile place_of(std::size_t number) const;
    std::optional<Blur> blur_of(PlannedTile &tile) const;
    bool moved_light_reaches(const PlannedTile &tile) const;
    std::vector<int> cells_asked_for() const;
    bool has_wide_lamps() const;
    void gather_from(const Level &level, const Blur &blur, PlannedTile &tile);

    const GatherScene &scene_;
    const LensGatherOptions &options_;
    Windows picture_;
    const Optics &optics_ = *scene_.optics;
    // Parts of a tile, across and down, each with lens points of its own.
    const int parts_ = optics_.field.skews() ? 2 : 1;
    LensTiles tiles_;
    LensSets sets_;
    std::list<Level> levels_;        // the one of full size first
    const Level *casters_ = nullptr; // for tiles without cells
};

} // namespace sparselens
