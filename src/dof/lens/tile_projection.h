// Where a lens point sees samples: the cells of a square grid that they fall in, moved by their circles of confusion.
#pragma once

#include "dof/lens/sample_blocks.h"
#include "lens/lens_samples.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

struct TileProjection {
    float lens_x, lens_y;   // displacement for each pixel of CoC
    float tile_x, tile_y;   // corner of the grid inside its border, pixels, as the samples count them
    float shift_x, shift_y; // of all samples: the point of the pixel that is looked through, and the border
    int stride;             // cells in a row, the border of one cell on either side among them

    TileProjection(const LensSample &lens, float corner_x, float corner_y, int row);
};

// The cell of each of `count` samples, counted row by row from the border's corner; what falls outside is in the
// border. The same bits on every processor.
void project_to_cells(const TileProjection &projection, const float *x, const float *y, const float *coc,
                      std::uint32_t count, std::int32_t *cells);

// The bounds of some blocks, side by side, as each lens point asks them which blocks it brings into a tile.
class BlockBounds {
public:
    struct Box { // pixels, as the samples count them
        float left, right, top, bottom;
    };
    void set(std::span<const std::uint32_t> blocks, const BlockedSamples &samples);
    // The blocks of which a lens point may bring samples into the box, in their order; until the next call.
    std::span<const std::uint32_t> reached(const LensSample &lens, const Box &box);

private:
    std::span<const std::uint32_t> blocks_;
    std::vector<float> x_min_, x_max_, y_min_, y_max_, coc_min_, coc_max_;
    std::vector<std::int32_t> in_reach_;
    std::vector<std::uint32_t> reached_;
};

} // namespace sparselens
