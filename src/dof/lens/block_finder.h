// Which blocks of samples can reach a tile.
#pragma once

#include "dof/lens/sample_blocks.h"
#include "lens/aperture.h"

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sparselens {

class BlockFinder {
public:
    // The samples outlive this.
    BlockFinder(const BlockedSamples &samples, const Aperture &aperture, double pixel_aspect);

    // Or the pixels next to it. `stretched`: by how much lens points are at most. Returns the largest CoC that shows: that
    // of backgrounds does where something opaque hides them.
    float find(const Imath::V2i &origin, int size, float stretched, std::vector<std::uint32_t> &found) const;
    float extent() const { return extent_; }

private:
    float reach_of(const SampleBlock &block) const;

    const BlockedSamples &samples_;
    float extent_; // of the aperture, for each pixel of CoC
    std::vector<float> row_reach_;
};

} // namespace sparselens
