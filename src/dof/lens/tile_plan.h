// Which tiles of a picture are out of focus, and what each of them is gathered from.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/cells.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/lens_sets.h"
#include "dof/lens/lens_tiles.h"
#include "dof/lens/scene_blocks.h"

#include <cstddef>
#include <list>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

struct PlannedTile {
    std::size_t number; // in the plan
    std::size_t tile;   // of the picture
    Imath::Box2i part;  // of the tile, that is gathered
    Imath::V2i first;   // pixel of the tile, EXR coordinates
    TileBlocks blocks = {};
    std::span<const LensSample> lens = {};
    const GatherScene *scene = nullptr;  // that it is gathered from
    std::optional<TileCells> cells = {}; // set if the scene is a coarse one
    TileBlocks cell_blocks = {};         // the blocks of the coarse scene
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
        float largest; // CoC
        float stretched;
        int cells; // size of the cells that it asks for; 1: none
    };
    PlannedTile place_of(std::size_t number) const;
    std::optional<Blur> blur_of(PlannedTile &tile) const;
    bool moved_light_reaches(const PlannedTile &tile) const;
    std::vector<int> cells_asked_for() const;
    void gather_from(const Level &level, const Blur &blur, PlannedTile &tile);

    const GatherScene &scene_;
    const LensGatherOptions &options_;
    Windows picture_;
    const Optics &optics_ = *scene_.optics;
    // Parts of a tile, across and down, each with lens points of its own.
    const int parts_ = optics_.field.skews() ? 2 : 1;
    LensTiles tiles_;
    LensSets sets_;
    std::list<Level> levels_; // the one of full size first
};

} // namespace sparselens
