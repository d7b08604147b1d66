// Finds where a lens point sees samples: in which cells of a square grid they fall, moved by their circles of
// confusion.
#pragma once

#include "dof/lens/sample_blocks.h"
#include "lens/lens_samples.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

struct TileProjection {
    float lens_x, lens_y; // displacement for each pixel of CoC
    // corner of the grid inside its border, pixels, in the coordinates of the samples
    float tile_x, tile_y;
    float shift_x, shift_y; // of all samples: the point of the pixel that is looked through, and the border
    int stride;             // cells in a row, the border of one cell on either side among them

    TileProjection(const LensSample &lens, float corner_x, float corner_y, int row);
};

// Finds the cell of each of `count` samples, counted row by row from the border's corner. Samples outside are put into
// the border. The results are the same on every processor.
void project_to_cells(const TileProjection &projection, const float *x, const float *y, const float *coc,
                      std::uint32_t count, std::int32_t *cells);

// The bounds of some blocks, stored contiguously, because each lens point tests them to find the blocks that it brings
// into a tile.
class BlockBounds {
public:
    struct Box { // pixels, in the coordinates of the samples
        float left, right, top, bottom;
    };
    void set(std::span<const std::uint32_t> blocks, const BlockedSamples &samples);
    // Returns, in order, the blocks of which a lens point may bring samples into the box. Valid until the next call.
    std::span<const std::uint32_t> reached(const LensSample &lens, const Box &box);

private:
    std::span<const std::uint32_t> blocks_;
    std::vector<float> x_min_, x_max_, y_min_, y_max_, coc_min_, coc_max_;
    std::vector<std::int32_t> in_reach_;
    std::vector<std::uint32_t> reached_;
};

} // namespace sparselens
