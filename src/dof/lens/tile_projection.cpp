#include "dof/lens/tile_projection.h"

namespace sparselens {

TileProjection::TileProjection(const LensSample &lens, float corner_x, float corner_y, int row)
    : lens_x(lens.x), lens_y(lens.y), tile_x(corner_x), tile_y(corner_y), shift_x(lens.pixel_x + 1),
      shift_y(lens.pixel_y + 1), stride(row) {}

// Compiled for several instruction sets, as this loop is most of the gather's work; they all give the same. Not
// under ThreadSanitizer, as the loader chooses among them before that has begun.
#ifndef __SANITIZE_THREAD__
[[gnu::target_clones("default,avx2")]]
#endif
void project_to_cells(const TileProjection &p, const float *x, const float *y, const float *coc, std::uint32_t count,
           std::int32_t *cells) {
    const int stride = p.stride; // copies: the compiler need not fear that cells overlap them
    const float limit = float(stride - 1);
    for (std::uint32_t i = 0; i < count; ++i) {
        // The tile's place is taken off first, so that far from the corner nothing is rounded more than near it.
        const float cx = (x[i] - p.tile_x) + (coc[i] * p.lens_x + p.shift_x);
        const float cy = (y[i] - p.tile_y) + (coc[i] * p.lens_y + p.shift_y);
        const float column = cx > 0 ? (cx < limit ? cx : limit) : 0,
                    row = cy > 0 ? (cy < limit ? cy : limit) : 0;
        cells[i] = std::int32_t(row) * stride + std::int32_t(column);
    }
}

} // namespace sparselens
