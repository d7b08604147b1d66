// Finds the blocks of all parts of a scene that can reach a tile.
#pragma once

#include "dof/lens/block_finder.h"
#include "dof/lens/gather_scene.h"

namespace sparselens {

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

} // namespace sparselens
