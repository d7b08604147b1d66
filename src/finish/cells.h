// Square cells of pixels. Sums over windows of many pixels change little from one pixel to the next, so they are
// computed for cells and interpolated between the middles of cells.
#pragma once

#include "base/grid.h"
#include "finish/colours.h"

#include <span>

namespace sparselens {

// Pixels of a row that are processed at once; entries beyond its end are 0.
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
    // The pixel rows of a row of cells: the first, and the one after the last.
    std::array<std::size_t, 2> rows(std::size_t row) const;

    // Adds a run that begins at column x to a row of sums.
    void add(const Run &run, std::size_t x, std::span<float> sums) const;
    // Divides a row of sums, which gives the means over the pixels of each cell.
    void divide(std::size_t row, std::span<float> sums) const;
    // One row of a plane of cells.
    std::span<float> of_row(Values &plane, std::size_t row) const;

    // Sets the pixels of row y, interpolated between the middles of cells, and some entries beyond its end.
    void interpolate(const Values &plane, std::size_t y, std::vector<float> &pixels) const;

private:
    Grid pixels_, grid_;
    std::size_t side_;
};

} // namespace sparselens
