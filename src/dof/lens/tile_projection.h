// Finds where a lens point sees samples: in which cells of a tile they fall, moved by their circles of confusion.
#pragma once

#include "base/image.h"
#include "dof/lens/cell_rows.h"
#include "dof/lens/sample_blocks.h"
#include "kernels/lens_rules.h"
#include "lens/lens_samples.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// Returns the units, without depths, for samples with these CoCs and lens points.
kernels::TileUnits tile_units(float largest_coc, std::span<const LensSample> lens);

// Places of samples in units, stored contiguously for vectors of `lanes`.
struct WholePlaces {
    static constexpr std::uint32_t lanes = 16;
    LargeArray<std::int16_t> x, y, coc;

    std::uint32_t count() const { return std::uint32_t(x.size()); }
    // Appends samples, and up to a multiple of `lanes` places outside of the tile. `middle`: of the tile.
    void add(const kernels::TileUnits &units, const Imath::V2f &middle, const float *from_x,
             const float *from_y, const float *from_coc, std::uint32_t samples);
};

// Finds the cells of `count` places from `begin` on; both are multiples of WholePlaces::lanes.
inline void project_to_cells(const WholeLens &lens, const WholePlaces &places, std::uint32_t begin,
                             std::uint32_t count, std::uint16_t *cells) {
    project_to_cells(lens, places.x.data() + begin, places.y.data() + begin, places.coc.data() + begin, count,
                     cells);
}

// The bounds of some blocks, stored contiguously, because each lens point tests them to find the blocks that it brings
// into a tile.
class BlockBounds {
public:
    struct Box { // pixels, in the coordinates of the samples
        float left, right, top, bottom;
    };
    void set(std::span<const std::uint32_t> blocks, const BlockedSamples &samples,
             const kernels::TileUnits &units);
    // Returns, in order, the indices of the blocks of which a lens point may bring samples into the box. Valid until
    // the next call.
    std::span<const std::uint32_t> reached(const LensSample &lens, const Box &box);

private:
    float rounding_ = 0; // pixels: more than any position is off
    std::vector<float> x_min_, x_max_, y_min_, y_max_, coc_min_, coc_max_;
    std::vector<std::int32_t> in_reach_;
    std::vector<std::uint32_t> reached_;
};

} // namespace sparselens
