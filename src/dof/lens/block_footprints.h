// What the samples of a picture cover, by blocks: asked for by what casts shadows on small lamps (highlight_tile.h).
#pragma once

#include "dof/footprints/footprint.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/shadow_areas.h"

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace sparselens {

// The footprints of a sample and of all nearer ones of its block lie within these.
struct NearBounds {
    float depth; // perceptive, pixels: of the sample
    float x_min, x_max, y_min, y_max, coc_min, coc_max;
};

// The footprints of the samples of a picture, by blocks.
class BlockFootprints {
public:
    BlockFootprints(const Ldi &ldi, const BlockedSamples &samples);

    struct Block {
        std::vector<Footprint> footprints; // of its samples
        std::vector<NearBounds> near;      // the nearest first
        // Of the samples that are nearer than a perceptive depth; null: there are none.
        const NearBounds *nearer_than(float depth) const;
    };
    // Computed when first asked for, by any thread.
    const Block &of(std::uint32_t block) const;
    // What many blocks hold, without their footprints.
    const ShadowAreas &areas() const { return areas_; }

private:
    std::vector<Footprint> compute(std::uint32_t block) const;
    std::vector<NearBounds> bounds_of(const SampleBlock &block, std::span<const Footprint> footprints) const;

    const Ldi &ldi_;
    const BlockedSamples &samples_;
    ShadowAreas areas_;
    mutable std::vector<std::once_flag> made_;
    mutable std::vector<Block> computed_;
};

} // namespace sparselens
