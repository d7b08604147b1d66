// Square cells of pixels. What windows of many pixels say changes little from one pixel to the next, so it is worked out for cells
// and interpolated between their middles.
#pragma once

#include "base/grid.h"
#include "finish/colours.h"

#include <span>

namespace sparselens {

// Pixels of a row that are treated at once; those behind its end are 0.
constexpr std::size_t run_length = 64;
using Run = std::array<float, run_length>;

class Cells {
public:
    // `side`: 1, 2, 4 or 8 pixels. Cells at the right and lower border may be smaller.
    Cells(const Grid &pixels, int side);

    const Grid &pixels() const { return pixels_; }
    const Grid &grid() const { return grid_; } // of the cells
    std::size_t side() const { return side_; }
    std::size_t row_of(std::size_t y) const { return y / side_; }
    // The pixel rows of a row of cells: the first, and the one behind the last.
    std::array<std::size_t, 2> rows(std::size_t row) const;

    // Adds a run that begins at column x to a row of sums.
    void add(const Run &run, std::size_t x, std::span<float> sums) const;
    // Makes a row of sums the means over the pixels of each cell.
    void divide(std::size_t row, std::span<float> sums) const;
    // The row of a plane of cells.
    std::span<float> of_row(Values &plane, std::size_t row) const;

    // The pixels of row y, between the middles of cells, and some behind its end.
    void interpolate(const Values &plane, std::size_t y, std::vector<float> &pixels) const;

private:
    Grid pixels_, grid_;
    std::size_t side_;
};

} // namespace sparselens
