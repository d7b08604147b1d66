// Finds the blocks of samples that can reach a tile.
#pragma once

#include "dof/lens/sample_blocks.h"
#include "lens/aperture.h"

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sparselens {

// The CoCs of the samples that can reach a tile, without their signs, pixels.
struct ReachingCocs {
    // The largest that shows. Backgrounds count only where something opaque hides them.
    float largest = 0;
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

} // namespace sparselens
