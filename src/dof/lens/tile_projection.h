// Where a lens point sees samples: the cells of a square grid that they fall in, moved by their circles of confusion.
#pragma once

#include "lens/lens_samples.h"

#include <cstdint>

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

} // namespace sparselens
