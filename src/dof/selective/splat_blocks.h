// The splats of an LDI in the order in which a gather wants them: cut into cells, one a bin of depth in a
// block of pixels, sorted front to back. What bounds a cell (where it lies, how far it reaches) lets a tile
// take or leave all of it at once, so that one huge circle of confusion costs only its own cell.
#pragma once

#include "dof/selective/splats.h"

#include <Imath/ImathBox.h>

#include <span>
#include <vector>

namespace sparselens {

struct Cell {
    int bin = 0;
    std::size_t begin = 0, end = 0; // splats
    Imath::Box2d centres, reach;    // of the splats' centres; of all pixels that they can touch
    double smallest = 0;            // radius of the CoC
};

struct CellGrid {
    // One entry a splat, cell by cell.
    std::vector<double> x, y, radius;
    std::vector<float> values;         // [splat][size()]: coverage, known, colours, known * radius
    std::size_t colours = 0, bins = 0; // how many

    std::vector<Cell> cells; // ascending bins, then blocks
    std::vector<double>
        sums; // [cell][size()]: values / area of the PSF in pixels, where the cell can cover a tile

    std::size_t size() const { return sums_before_colours + colours + 1; }
    std::span<const float> value(std::size_t splat) const {
        return std::span(values).subspan(splat * size(), size());
    }
};

CellGrid make_cells(const SplatSource &source);

} // namespace sparselens
