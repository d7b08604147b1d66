// What may cast shadows on small lamps: the footprints of samples by blocks, and bounds of blocks and areas of
// blocks, so that most of them need not be looked at.
#pragma once

#include "dof/footprints/footprint.h"
#include "dof/lens/sample_blocks.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// Bounds of the samples, among many, that are nearer than some depth. Samples outside these bounds cast no shadow on a
// lamp.

// Bounds of all samples nearer than some depth, and perhaps of some others.
struct NearBounds {
    float depth; // of the nearest sample that is not included, disparity, pixels
    float x_min, x_max, y_min, y_max, coc_min, coc_max;
};

class NearSteps {
public:
    NearSteps() = default;
    // Takes the depth and the extent of each sample. One step is kept for every `in_step` samples.
    NearSteps(std::vector<NearBounds> samples, std::size_t in_step);

    // The bounds of all samples nearer than a depth; null: there are none.
    const NearBounds *nearer_than(float depth) const;

private:
    // Each step includes more samples, the nearest first. The first step has none, the last one has all.
    std::vector<NearBounds> steps_;
};

// Bounds of what may cast shadows on small lamps, by areas of 8 x 8 blocks. Most areas cast no shadow on a lamp in a
// tile; their blocks need not be tested.
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

    // Returns the bounds of the samples of an area that are nearer than a disparity; null: there are none. They
    // bound the centres of the samples, and the CoCs of their footprints (dof/footprints/footprint.h), whose edges lie
    // less than a pixel from the centres. May be called by any thread.
    const NearBounds *nearer_than(std::size_t area, float depth) const;
    // Whether any sample of an area may lie between two disparities.
    bool lies_between(std::size_t area, float farthest, float nearest) const {
        return depths_[area].nearest > farthest && depths_[area].farthest <= nearest;
    }

    // Returns the CoCs that footprints of an area's samples between two disparities may have. nearer_than() must
    // have been called for the area. The CoCs of two samples differ as their disparities do, and the nearer one
    // has the smaller CoC, except in a bent field.
    CocRange cocs_between(std::size_t area, float farthest, float nearest) const {
        return {focus_[area].least - nearest, focus_[area].most - farthest};
    }

    // Returns by how much, in pixels, the CoC of an edge may differ from the CoC of its sample in a block.
    // nearer_than() must have been called for the block's area.
    float to_edges(std::uint32_t block) const { return to_edges_[block]; }

    // Whether any sample of a block may lie between two disparities; nearer_than() must have been called for its
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
    struct Depths { // disparity
        float farthest = std::numeric_limits<float>::max(), nearest = 0;
    };
    std::vector<Depths> depths_; // [area]
    mutable std::vector<std::once_flag> made_;
    mutable std::vector<NearSteps> steps_; // [area]
    // [area]: the range of CoC plus disparity, which is the disparity of the focus.
    mutable std::vector<CocRange> focus_;
    mutable std::vector<BlockDepths> block_depths_;
    mutable std::vector<float> to_edges_; // [block]
};

// The footprints of the samples of a picture, by blocks. The shadows on small lamps (highlight_tile.h) are computed
// from them.
class BlockFootprints {
public:
    // `links`: of the LDI that the samples are from. Without them, samples that part are not joined.
    BlockFootprints(const Ldi &ldi, const BlockedSamples &samples, std::optional<Links> links = {});
    BlockFootprints(const BlockFootprints &) = delete; // its parts refer to each other

    struct DepthRange { // disparity
        float farthest, nearest;
    };
    struct Block {
        std::vector<JoinedFootprint> alone, joined; // footprints of its samples
        std::vector<DepthRange> joined_over;        // the ranges of depth of joined footprints, ascending
        NearSteps near;                             // bounds of the joined footprints

        // Returns the joined footprints; the single ones if a joined one could lie on both sides of a lamp whose
        // disparity is between these.
        const std::vector<JoinedFootprint> &apart_from(float farthest, float nearest) const;
    };
    // Computed when first asked for, by any thread.
    const Block &of(std::uint32_t block) const;
    // Bounds of areas of many blocks, which need no footprints.
    const ShadowAreas &areas() const { return areas_; }

private:
    SamplesInPicture in_picture() const;
    std::vector<Footprint> compute(std::uint32_t block) const;

    const Ldi &ldi_;
    const BlockedSamples &samples_;
    std::optional<Links> links_;
    ShadowAreas areas_;
    mutable std::vector<std::once_flag> made_;
    mutable std::vector<Block> computed_;
};

} // namespace sparselens
