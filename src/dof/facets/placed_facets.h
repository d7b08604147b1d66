// Draws facets, as a lens point sees them, into a grid of cells. Each cell keeps the greatest word.
#pragma once

#include "base/image.h"
#include "dof/facets/facets.h"
#include "lens/lens_samples.h"

#include <span>

namespace sparselens {

struct FacetBlock {
    std::uint32_t begin, end;
    float x_min, x_max, y_min, y_max; // of the facets' corners, pixels
    float coc_min, coc_max;           // pixels, signed
};

struct PlacedFacets {
    // [corner][facet]
    std::array<LargeArray<float>, 3> x, y, coc; // of the facet's samples, pixels, in the picture
    std::array<LargeArray<std::uint32_t>, 3> sample;
    std::vector<FacetBlock> blocks;
};

// The samples at the corners of facets.
struct FacetCorners {
    std::span<const float> x, y, coc;
    // Index into the LDI's samples; an index beyond their number is none of them.
    std::span<const std::uint32_t> source;
};

PlacedFacets place_facets(const FacetBlocks &found, std::size_t ldi_samples, const FacetCorners &corners);

// Finds the blocks with facets that can reach the tile [origin, origin + size), or the pixels next to it, through some
// lens point. `widest`: the largest distance of a lens point from the middle, in pixels per pixel of CoC.
void find_blocks(const PlacedFacets &facets, const Imath::V2i &origin, int size, float widest,
                 std::vector<std::uint32_t> &found);

// A square grid of cells with a border of one cell: cell (1, 1) shows the pixel at `corner`, and (last, last) is the
// last cell that is drawn into.
struct FacetGrid {
    float corner_x, corner_y;
    int stride, last;
};

// Draws the facets of some blocks where the lens point sees them. `words`: of the corners of each of these facets.
void draw_facets(const PlacedFacets &facets, std::span<const std::uint32_t> blocks,
                 std::span<const std::array<std::int32_t, 3>> words, const LensSample &lens,
                 const FacetGrid &grid, std::span<std::int32_t> cells);

} // namespace sparselens
