// Bounds of what may cast shadows on small lamps, by areas of 8 x 8 blocks: most areas cast none on a lamp in a tile, and none
// of their blocks need be asked.
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

    // `links`: what joins samples that part (dof/footprints/footprint.h), or null. Both outlive this.
    ShadowAreas(const BlockedSamples &samples, const Links *links);

    std::size_t count() const { return depths_.size(); }
    // The area that a block lies in.
    std::size_t of(std::uint32_t block) const {
        const int column = int(block) % samples_.columns, row = int(block) / samples_.columns;
        return std::size_t(row / size) * std::size_t(columns_) + std::size_t(column / size);
    }

    // The blocks of an area, ascending.
    std::vector<std::uint32_t> blocks_of(std::size_t area) const;

    // The bounds of the samples of an area nearer than a perceptive depth; null: there are none. Bounds are of their
    // centres, and of the CoCs of their footprints (dof/footprints/footprint.h), whose edges lie less than a pixel from
    // the centres. For any thread.
    const NearBounds *nearer_than(std::size_t area, float depth) const;
    // Whether any of it may lie between two perceptive depths.
    bool lies_between(std::size_t area, float farthest, float nearest) const {
        return depths_[area].nearest > farthest && depths_[area].farthest <= nearest;
    }

    // The CoCs that footprints of the samples of an area may have which lie between two perceptive depths; of an area that nearer_than()
    // was asked of. Of two samples the nearer one has the lesser CoC, by what their depths differ: but for a bent field.
    CocRange cocs_between(std::size_t area, float farthest, float nearest) const {
        return {focus_[area].least - nearest, focus_[area].most - farthest};
    }

    // By how much the CoC of an edge may differ from that of its sample in a block, pixels; of an area that nearer_than() was asked of.
    float to_edges(std::uint32_t block) const { return to_edges_[block]; }

    // Whether any sample of a block may lie between two perceptive depths; of an area that nearer_than() was asked of.
    bool block_lies_between(std::uint32_t block, float farthest, float nearest) const {
        return block_depths_[block].lies_between(farthest, nearest);
    }

private:
    // At which depths, of 64 from its farthest to its nearest, a block has samples, bit by bit.
    struct BlockDepths {
        float farthest = 0, in_px = 0; // steps in a pixel
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
    mutable std::vector<CocRange>
        focus_; // [area]: of CoC and perceptive depth together, which is that of the focus
    mutable std::vector<BlockDepths> block_depths_;
    mutable std::vector<float> to_edges_; // [block]
};

} // namespace sparselens
