// How many lens points the lens gather chose for each tile of its window.
#pragma once

#include <map>
#include <vector>

namespace sparselens {

inline constexpr int lens_tile_size = 64; // pixels wide and high: what a lens point sees stays in the cache

struct LensTiles {
    int size = lens_tile_size;    // pixels wide and high; less at the right and lower edge
    int columns = 0, rows = 0;    // from the window's upper left corner
    std::vector<int> lens_points; // [row][column]; 0: nothing is out of focus, the flattened LDI is copied
};

// The number of tiles for each number of lens points.
inline std::map<int, int> histogram(const LensTiles &tiles) {
    std::map<int, int> result;
    for (const int points : tiles.lens_points) ++result[points];
    return result;
}

} // namespace sparselens
