// The footprints of the samples of a picture, by blocks. The shadows on small lamps (highlight_tile.h) are computed
// from them.
#pragma once

#include "dof/footprints/joined_footprints.h"
#include "dof/lens/near_bounds.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/shadow_areas.h"

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

class BlockFootprints {
public:
    // `links`: of the LDI that the samples are from. Without them, samples that part are not joined.
    BlockFootprints(const Ldi &ldi, const BlockedSamples &samples, std::optional<Links> links = {});
    BlockFootprints(const BlockFootprints &) = delete; // its parts refer to each other

    struct Block {
        std::vector<JoinedFootprint> alone, joined; // footprints of its samples
        NearSteps near;                             // bounds of the joined footprints

        // Returns the joined footprints; the single ones if a joined one could lie on both sides of a lamp whose
        // perceptive depth is between these.
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
