#include "dof/facets/placed_facets.h"

#include "base/parallel.h"
#include "kernels/lens_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

constexpr std::uint32_t nowhere = ~0u;

// Returns the index of each sample of the LDI among the corners, or `nowhere`.
std::vector<std::uint32_t> places_of(std::size_t ldi_samples, std::span<const std::uint32_t> source) {
    std::vector<std::uint32_t> places(ldi_samples, nowhere);
    parallel_ranges(source.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (source[i] < ldi_samples) places[source[i]] = std::uint32_t(i);
    });
    return places;
}

void widen(FacetBlock &block, const PlacedFacets &facets, std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
        block.x_min = std::min(block.x_min, facets.x[k][i]);
        block.x_max = std::max(block.x_max, facets.x[k][i]);
        block.y_min = std::min(block.y_min, facets.y[k][i]);
        block.y_max = std::max(block.y_max, facets.y[k][i]);
        block.coc_min = std::min(block.coc_min, facets.coc[k][i]);
        block.coc_max = std::max(block.coc_max, facets.coc[k][i]);
    }
}

bool out_of_reach(const FacetBlock &b, const LensSample &lens, const FacetGrid &grid) {
    const auto [x0, x1] = std::minmax({b.coc_min * lens.x, b.coc_max * lens.x});
    const auto [y0, y1] = std::minmax({b.coc_min * lens.y, b.coc_max * lens.y});
    const float size = float(grid.last);
    const float x = grid.corner_x - lens.pixel_x, y = grid.corner_y - lens.pixel_y;
    return b.x_max + x1 + 1 < x || b.x_min + x0 - 1 > x + size || b.y_max + y1 + 1 < y ||
           b.y_min + y0 - 1 > y + size;
}

constexpr std::size_t at_once = 64;

// Extents of some facets along one axis: where a lens point sees their corners, in cells from the middle of the first
// cell; the least and the greatest of these; and the first and last of the cells 1 to `last` whose middle lies between
// the corners.
struct Extents {
    std::array<std::array<float, at_once>, 3> at;
    std::array<float, at_once> least, most;
    std::array<std::int32_t, at_once> first, last;
};

struct Seen {
    Extents x, y;
    std::array<std::int32_t, at_once> drawn;
    std::array<std::uint32_t, at_once> list; // the facets that are drawn
};

// Plain loops, so that the compiler computes several facets at once.
[[gnu::always_inline]] inline void measure(Extents &e, std::size_t count, float last) {
    for (std::size_t i = 0; i < count; ++i) e.least[i] = e.at[0][i] < e.at[1][i] ? e.at[0][i] : e.at[1][i];
    for (std::size_t i = 0; i < count; ++i) e.least[i] = e.least[i] < e.at[2][i] ? e.least[i] : e.at[2][i];
    for (std::size_t i = 0; i < count; ++i) e.most[i] = e.at[0][i] > e.at[1][i] ? e.at[0][i] : e.at[1][i];
    for (std::size_t i = 0; i < count; ++i) e.most[i] = e.most[i] > e.at[2][i] ? e.most[i] : e.at[2][i];
    for (std::size_t i = 0; i < count; ++i) e.first[i] = kernels::first_between(e.least[i], last);
    for (std::size_t i = 0; i < count; ++i) e.last[i] = kernels::last_between(e.most[i], last);
}

// The corners of consecutive facets.
struct Corners {
    std::array<const float *, 3> x, y, coc;
};

// Facets that reach no cell, or that their samples cover, are not drawn.
FOR_PROCESSORS
void project(const Corners &corners, const LensSample &lens, const FacetGrid &grid, std::size_t count,
             Seen &seen) {
    const float lens_x = lens.x, lens_y = lens.y, corner_x = grid.corner_x, corner_y = grid.corner_y;
    const float shift_x = lens.pixel_x + kernels::shift_of_facets,
                shift_y = lens.pixel_y + kernels::shift_of_facets;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < count; ++i) {
            seen.x.at[k][i] =
                kernels::seen_along(corners.x[k][i], corner_x, corners.coc[k][i], lens_x, shift_x);
            seen.y.at[k][i] =
                kernels::seen_along(corners.y[k][i], corner_y, corners.coc[k][i], lens_y, shift_y);
        }
    measure(seen.x, count, float(grid.last));
    measure(seen.y, count, float(grid.last));
    for (std::size_t i = 0; i < count; ++i) {
        const int parted = int(seen.x.most[i] - seen.x.least[i] > kernels::parted_px) |
                           int(seen.y.most[i] - seen.y.least[i] > kernels::parted_px);
        seen.drawn[i] =
            parted & int(seen.x.first[i] <= seen.x.last[i]) & int(seen.y.first[i] <= seen.y.last[i]);
    }
}

void draw_triangle(const Seen &seen, std::size_t i, const std::array<std::int32_t, 3> &words, int stride,
                   std::span<std::int32_t> cells) {
    const float x0 = seen.x.at[0][i], x1 = seen.x.at[1][i], x2 = seen.x.at[2][i];
    const float y0 = seen.y.at[0][i], y1 = seen.y.at[1][i], y2 = seen.y.at[2][i];
    const float side = kernels::twice_area(x0, y0, x1, y1, x2, y2) < 0 ? -1.0f : 1.0f; // seen from behind: -1
    for (int row = seen.y.first[i]; row <= seen.y.last[i]; ++row)
        for (int column = seen.x.first[i]; column <= seen.x.last[i]; ++column) {
            const float x = float(column), y = float(row);
            // Areas opposite the corners.
            const float a = side * kernels::twice_area(x1, y1, x2, y2, x, y);
            const float b = side * kernels::twice_area(x2, y2, x0, y0, x, y);
            const float c = side * kernels::twice_area(x0, y0, x1, y1, x, y);
            const std::int32_t nearest = words[kernels::nearest_corner(a, b, c)];
            const bool inside = int(a >= 0) & int(b >= 0) & int(c >= 0); // branch-free: unpredictable
            std::int32_t &cell = cells[std::size_t(row * stride + column)];
            cell = std::max(cell, nearest * inside);
        }
}

} // namespace

PlacedFacets place_facets(const FacetBlocks &found, std::size_t ldi_samples, const FacetCorners &corners) {
    PlacedFacets placed;
    if (found.blocks.empty()) return placed;
    constexpr float most = std::numeric_limits<float>::max();
    std::uint32_t count = 0;
    for (const std::vector<Facet> &block : found.blocks) {
        const std::uint32_t begin = std::exchange(count, count + std::uint32_t(block.size()));
        placed.blocks.push_back({begin, count, most, -most, most, -most, most, -most});
    }
    for (auto *along : {&placed.x, &placed.y, &placed.coc})
        for (LargeArray<float> &values : *along) values.resize(count);
    for (LargeArray<std::uint32_t> &samples : placed.sample) samples.resize(count);
    const std::vector<std::uint32_t> places = places_of(ldi_samples, corners.source);
    parallel_for(placed.blocks.size(), [&](std::size_t b) {
        FacetBlock &block = placed.blocks[b];
        for (std::uint32_t f = block.begin; f < block.end; ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t i = places[found.blocks[b][f - block.begin].sample[k]];
                placed.x[k][f] = corners.x[i];
                placed.y[k][f] = corners.y[i];
                placed.coc[k][f] = corners.coc[i];
                placed.sample[k][f] = i;
            }
            widen(block, placed, f);
        }
    });
    return placed;
}

void find_blocks(const PlacedFacets &facets, const Imath::V2i &origin, int size, float widest,
                 std::vector<std::uint32_t> &found) {
    const Imath::V2f first(Imath::V2f(origin) - Imath::V2f(1)),
        last(Imath::V2f(origin) + Imath::V2f(float(size + 1)));
    found.clear();
    for (std::uint32_t b = 0; b < facets.blocks.size(); ++b) {
        const FacetBlock &block = facets.blocks[b];
        const float reach = std::max(std::abs(block.coc_min), std::abs(block.coc_max)) * widest + 1;
        if (block.x_max + reach >= first.x && block.x_min - reach <= last.x &&
            block.y_max + reach >= first.y && block.y_min - reach <= last.y)
            found.push_back(b);
    }
}

void draw_facets(const PlacedFacets &facets, std::span<const std::uint32_t> blocks,
                 std::span<const std::array<std::int32_t, 3>> words, const LensSample &lens,
                 const FacetGrid &grid, std::span<std::int32_t> cells) {
    Seen seen;
    for (const std::uint32_t b : blocks) {
        const FacetBlock &block = facets.blocks[b];
        const auto of_block = words.first(block.end - block.begin);
        words = words.subspan(of_block.size());
        if (out_of_reach(block, lens, grid)) continue;
        for (std::size_t begin = block.begin; begin < block.end; begin += at_once) {
            const std::size_t count = std::min(at_once, block.end - begin);
            Corners corners;
            for (std::size_t k = 0; k < 3; ++k) {
                corners.x[k] = &facets.x[k][begin];
                corners.y[k] = &facets.y[k][begin];
                corners.coc[k] = &facets.coc[k][begin];
            }
            project(corners, lens, grid, count, seen);
            std::size_t drawn = 0;
            for (std::size_t i = 0; i < count; ++i) {
                seen.list[drawn] = std::uint32_t(i);
                drawn += std::size_t(seen.drawn[i]);
            }
            for (const std::uint32_t i : std::span(seen.list).first(drawn))
                draw_triangle(seen, i, of_block[begin - block.begin + i], grid.stride, cells);
        }
    }
}

} // namespace sparselens
