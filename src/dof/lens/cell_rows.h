// The loops over samples and cells that take most of the gather's time. Each gives the same bits on every processor.
// The compiler makes their vectors, which needs no library in every plugin and wheel.
#pragma once

#include "base/numbers.h"
#include "kernels/lens_rules.h"
#include "lens/lens_samples.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace sparselens {

// The cells of a tile: its pixels, a border of one pixel around them, and a border of cells that take what falls
// outside of both.
namespace tile_cells {
using lens_kernel::border;
constexpr int size = lens_kernel::tile_size, stride = lens_kernel::tile_stride;
constexpr std::size_t count = std::size_t(stride * stride), pixels = std::size_t(size * size);
constexpr std::size_t at(int x, int y) { return std::size_t((y + border) * stride + x + border); }
constexpr int column(std::size_t cell) { return int(cell) % stride - border; }
constexpr int row(std::size_t cell) { return int(cell) / stride - border; }
} // namespace tile_cells

using CellWord = std::int32_t; // what a cell shows (tile_samples.h); 0: nothing

inline constexpr std::size_t points_at_once = 4; // lens points whose colours are added together

// A lens point in units.
struct WholeLens {
    std::int16_t x, y, shift_x, shift_y;
    std::int16_t first, last; // the border's first unit and last one
    std::int16_t to_pixel;    // 65536 / unit

    WholeLens(const kernels::TileUnits &units, const LensSample &lens);
};

// Rounds places along an axis, and CoCs, to whole numbers (kernels/lens_rules.h). `middle`: of the tile.
void whole_places(const kernels::TileUnits &units, float middle, const float *at, std::size_t count,
                  std::int16_t *to);
void whole_cocs(const kernels::TileUnits &units, const float *coc, std::size_t count, std::int16_t *to);

// Finds the cell in which a lens point sees each sample. A sample outside of the tile gets a cell of the border.
void project_to_cells(const WholeLens &lens, const std::int16_t *x, const std::int16_t *y,
                      const std::int16_t *coc, std::uint32_t count, std::uint16_t *cells);

// Along one axis: clears the entries of blocks that the lens point cannot move into [from, to), given that their
// samples lie between `least` and `most`, and their CoCs between those two. An entry stays where an infinite CoC times
// 0 says nothing.
void find_reached(const float *least, const float *most, const float *coc_of_least, const float *coc_of_most,
                  std::size_t count, float lens, float from, float to, std::int32_t *in_reach);

// Returns a bit for each of 64 words: whether it is 0.
std::uint64_t zeros_of(const CellWord *words);

// Returns a bit for each of 64 cells: whether the words on two opposite sides of it are greater than its own, with
// `number_mask` set, by more than `step`, so that a crack may lie there. The cells around the 64 are read as well.
std::uint64_t far_behind(const CellWord *words, CellWord number_mask, CellWord step);

// Adds the colours of the numbers in rows of cells, each row by its factors, to `count` sums; `count` is even.
void add_rows(float *sums, const std::array<const CellWord *, points_at_once> &rows,
              const std::array<Float4, points_at_once> &factors, const float *colours, CellWord number_mask,
              int count);

} // namespace sparselens
