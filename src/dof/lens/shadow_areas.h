// Bounds of what may cast shadows on small lamps, by areas of 8 x 8 blocks: most areas cast none on a lamp in a tile, and none
// of their blocks need be asked.
#pragma once

#include "dof/lens/sample_blocks.h"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace sparselens {

// Of the samples that are nearer than some depth, and perhaps of some that are not. Their centres, and the CoCs of their
// footprints (dof/footprints/footprint.h), whose edges lie less than a pixel from the centres.
struct ShadowBounds {
    float depth; // of the nearest sample that is not within, perceptive, pixels
    float x_min, x_max, y_min, y_max, coc_min, coc_max;
};

class ShadowAreas {
public:
    static constexpr int size = 8; // blocks an area is wide and high

    explicit ShadowAreas(const BlockedSamples &samples);

    // The area that a block lies in.
    std::size_t of(std::uint32_t block) const {
        const int column = int(block) % samples_.columns, row = int(block) / samples_.columns;
        return std::size_t(row / size) * std::size_t(columns_) + std::size_t(column / size);
    }

    // Of the samples of an area that are nearer than a perceptive depth; null: there are none. For any thread.
    const ShadowBounds *nearer_than(std::size_t area, float depth) const;

private:
    std::vector<ShadowBounds> steps_of(std::size_t area) const;

    const BlockedSamples &samples_;
    int columns_;
    mutable std::vector<std::once_flag> made_;
    mutable std::vector<std::vector<ShadowBounds>> steps_; // [area]: more and more samples, the nearest first
};

} // namespace sparselens
