// Bounds of what may cast shadows on small lamps, by areas of 8 x 8 blocks. Most areas cast no shadow on a lamp in a
// tile; their blocks need not be tested.
#pragma once

#include "dof/footprints/footprint.h"
#include "dof/lens/near_bounds.h"
#include "dof/lens/sample_blocks.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <vector>

namespace sparselens {

struct CocRange {
    float least, most; // pixels, signed
};

class ShadowAreas {
public:
    static constexpr int size = 8; // blocks an area is wide and high

    // `links`: what joins samples that part (dof/footprints/footprint.h), or null. Both must outlive this.
    ShadowAreas(const BlockedSamples &samples, const Links *links);

    std::size_t count() const { return depths_.size(); }
    // The area that a block lies in.
    std::size_t of(std::uint32_t block) const {
        const int column = int(block) % samples_.columns, row = int(block) / samples_.columns;
        return std::size_t(row / size) * std::size_t(columns_) + std::size_t(column / size);
    }

    // The blocks of an area, ascending.
    std::vector<std::uint32_t> blocks_of(std::size_t area) const;

    // Returns the bounds of the samples of an area that are nearer than a perceptive depth; null: there are none. They
    // bound the centres of the samples, and the CoCs of their footprints (dof/footprints/footprint.h), whose edges lie
    // less than a pixel from the centres. May be called by any thread.
    const NearBounds *nearer_than(std::size_t area, float depth) const;
    // Whether any sample of an area may lie between two perceptive depths.
    bool lies_between(std::size_t area, float farthest, float nearest) const {
        return depths_[area].nearest > farthest && depths_[area].farthest <= nearest;
    }

    // Returns the CoCs that footprints of an area's samples between two perceptive depths may have. nearer_than() must
    // have been called for the area. The CoCs of two samples differ as their perceptive depths do, and the nearer one
    // has the smaller CoC, except in a bent field.
    CocRange cocs_between(std::size_t area, float farthest, float nearest) const {
        return {focus_[area].least - nearest, focus_[area].most - farthest};
    }

    // Returns by how much, in pixels, the CoC of an edge may differ from the CoC of its sample in a block.
    // nearer_than() must have been called for the block's area.
    float to_edges(std::uint32_t block) const { return to_edges_[block]; }

    // Whether any sample of a block may lie between two perceptive depths; nearer_than() must have been called for its
    // area.
    bool block_lies_between(std::uint32_t block, float farthest, float nearest) const {
        return block_depths_[block].lies_between(farthest, nearest);
    }

private:
    // A bit for each of 64 steps of depth, from a block's farthest sample to its nearest: whether it has samples there.
    struct BlockDepths {
        float farthest = 0, in_px = 0; // steps per pixel
        std::uint64_t steps = 0;

        std::uint64_t up_to(float depth) const;
        bool lies_between(float from, float to) const {
            return (steps & up_to(to) & ~(up_to(from) >> 1)) != 0;
        }
    };
    void find_depths(std::uint32_t block) const;
    void find_edges(std::size_t area) const;
    NearSteps steps_of(std::size_t area) const;
    CocRange focus_of(std::size_t area) const;

    const BlockedSamples &samples_;
    const Links *links_;
    int columns_;
    struct Depths { // perceptive
        float farthest = std::numeric_limits<float>::max(), nearest = 0;
    };
    std::vector<Depths> depths_; // [area]
    mutable std::vector<std::once_flag> made_;
    mutable std::vector<NearSteps> steps_; // [area]
    // [area]: the range of CoC plus perceptive depth, which is the perceptive depth of the focus.
    mutable std::vector<CocRange> focus_;
    mutable std::vector<BlockDepths> block_depths_;
    mutable std::vector<float> to_edges_; // [block]
};

} // namespace sparselens
