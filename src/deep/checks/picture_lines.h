// Rows and columns of a picture, spread evenly over it, enough of them to judge the whole picture.
#pragma once

#include "base/grid.h"

#include <algorithm>
#include <cstddef>

namespace sparselens {

// Pixels of a row or column, from the index of the first, `step` apart.
struct PictureLine {
    std::size_t first, step, length;
    std::size_t operator[](std::size_t i) const { return first + i * step; }
};

template <typename Visit> // visit(PictureLine)
void visit_lines(const Grid &grid, const Visit &visit) {
    constexpr std::size_t most = 512; // of each
    const auto width = std::size_t(grid.width()), height = std::size_t(grid.height());
    for (std::size_t y = 0; y < height; y += pieces_of(height, most)) visit(PictureLine{y * width, 1, width});
    for (std::size_t x = 0; x < width; x += pieces_of(width, most)) visit(PictureLine{x, width, height});
}

} // namespace sparselens
