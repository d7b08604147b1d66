// Bounds of what may cast shadows on small lamps, by areas of 8 x 8 blocks: most areas cast none on a lamp in a tile, and none
// of their blocks need be asked.
#pragma once

#include "dof/lens/near_bounds.h"
#include "dof/lens/sample_blocks.h"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace sparselens {

class ShadowAreas {
public:
    static constexpr int size = 8; // blocks an area is wide and high

    explicit ShadowAreas(const BlockedSamples &samples);

    // The area that a block lies in.
    std::size_t of(std::uint32_t block) const {
        const int column = int(block) % samples_.columns, row = int(block) / samples_.columns;
        return std::size_t(row / size) * std::size_t(columns_) + std::size_t(column / size);
    }

    // Of the samples of an area that are nearer than a perceptive depth; null: there are none. Their centres, and the CoCs of their
    // footprints (dof/footprints/footprint.h), whose edges lie less than a pixel from the centres. For any thread.
    const NearBounds *nearer_than(std::size_t area, float depth) const;

private:
    NearSteps steps_of(std::size_t area) const;

    const BlockedSamples &samples_;
    int columns_;
    mutable std::vector<std::once_flag> made_;
    mutable std::vector<NearSteps> steps_; // [area]
};

} // namespace sparselens
