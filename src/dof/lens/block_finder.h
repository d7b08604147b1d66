// Which blocks of samples can reach a tile.
#pragma once

#include "dof/lens/sample_blocks.h"
#include "lens/aperture.h"

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sparselens {

// What can reach a tile: CoCs without their signs, pixels.
struct ReachingCocs {
    float largest = 0; // that shows: that of backgrounds does where something opaque hides them
    float least = std::numeric_limits<float>::max();
    bool with_background = false; // whether light comes from behind all
};

class BlockFinder {
public:
    // The samples outlive this.
    BlockFinder(const BlockedSamples &samples, const Aperture &aperture, double pixel_aspect);

    // Finds the blocks that can reach a tile, or the pixels next to it, in their order. `stretched`: by how much lens
    // points are at most.
    ReachingCocs find(const Imath::V2i &origin, int size, float stretched,
                      std::vector<std::uint32_t> &found) const;
    float extent() const { return extent_; }

private:
    float reach_of(const SampleBlock &block) const;
    // Some blocks beside each other, and how far they reach.
    struct Run {
        std::uint32_t begin, end;
        float x_min, x_max, y_min, y_max, reach;
    };

    const BlockedSamples &samples_;
    float extent_; // of the aperture, for each pixel of CoC
    std::vector<Run> runs_;
};

} // namespace sparselens
