// Facets as a lens point draws them: into a grid of cells that each keep the greatest key.
#pragma once

#include "base/large_array.h"
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
    std::array<LargeArray<float>, 3> x, y, coc;   // of its samples, pixels, as they are placed
    std::array<LargeArray<std::uint64_t>, 3> key; // nearer is greater
    std::vector<FacetBlock> blocks;
};

// The samples at the corners of facets.
struct FacetCorners {
    std::span<const float> x, y, coc;
    std::span<const std::uint32_t> upper;  // of their keys, whose lower half is their place here
    std::span<const std::uint32_t> source; // of the LDI's samples, or none of them
};

PlacedFacets place_facets(const FacetBlocks &found, std::size_t ldi_samples, const FacetCorners &corners);

// The blocks of which a facet can reach the tile [origin, origin + size), or the pixels next to it, through some point of
// a lens that is no wider than that.
void find_blocks(const PlacedFacets &facets, const Imath::V2i &origin, int size, float widest,
                 std::vector<std::uint32_t> &found);

// A square grid of cells, that begins with one of border: cell (1, 1) shows the pixel at `corner`, and (last, last) is the last one
// that anything is drawn into.
struct FacetGrid {
    float corner_x, corner_y;
    int stride, last;
};

// Draws what the lens point sees of some blocks.
void draw_facets(const PlacedFacets &facets, std::span<const std::uint32_t> blocks, const LensSample &lens,
                 const FacetGrid &grid, std::span<std::uint64_t> cells);

} // namespace sparselens
