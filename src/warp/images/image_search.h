// The search for images in all blocks of the centre view that are worth it. Where a block has many depths to try, a picture of
// half the size is searched first, and then only depths near those that it shows: there are half as many depths in it, and a
// quarter of the pixels.
#pragma once

#include "base/grid.h"
#include "warp/images/image_sweep.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace sparselens {

// visit(tile) for the tiles around one.
template <typename Visit>
void for_each_beside(const Tiles &tiles, std::size_t tile, const Visit &visit) {
    const int column = int(tile) % tiles.columns(), row = int(tile) / tiles.columns();
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, tiles.rows() - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, tiles.columns() - 1); ++c)
            if (c != column || r != row) visit(std::size_t(r * tiles.columns() + c));
}

// What was found in a picture, by its pixels row by row; NaN: nothing.
struct ImageGuesses {
    Grid grid;
    std::vector<float> depths; // in its pixels

    // For a block of the picture that is twice as large, in the pixels of that.
    std::vector<float> near(const Imath::Box2i &block) const;
};

// Pixels are numbered block by block, of the blocks that are searched alone: most pictures show few mirrors.
class ImageSearch {
public:
    // Searches those blocks of `data`, and others where it has found something beside them.
    ImageSearch(const ImageSweep &sweep, const Imath::Box2i &data, const std::vector<std::size_t> &blocks);

    const ImageSweep &sweep() const { return sweep_; }
    const Imath::Box2i &box() const { return box_; }
    // npos: not searched, or outside.
    std::size_t index_of(const Imath::V2i &pixel) const;
    // By that number.
    std::vector<ImageMatch> matches;

    // The data window in bands of so many rows of blocks.
    std::size_t bands(std::size_t rows) const { return pieces_of(std::size_t(tiles_.rows()), rows); }
    // visit(block) for those of a band that were searched.
    template <typename Visit>
    void for_each_searched(std::size_t rows, std::size_t band, const Visit &visit) const {
        const std::size_t columns = std::size_t(tiles_.columns()), first = band * rows * columns,
                          count = std::min(rows * columns, tiles_.count() - first);
        sweep_.go_through(count, count, [&](std::size_t n) {
            if (blocks_[first + n] != not_searched) visit(tiles_.box(first + n));
        });
    }
    ImageGuesses guesses() const;

private:
    static constexpr std::uint32_t not_searched = ~0u;

    bool search_tile(std::size_t tile);

    const ImageSweep &sweep_;
    Imath::Box2i box_;
    Tiles tiles_;
    std::optional<ImageGuesses> guesses_; // of a picture of half the size, where it was searched
    std::vector<std::uint32_t> blocks_;   // by tile: which block of the numbers it is
    std::uint32_t count_ = 0;             // of blocks
};

} // namespace sparselens
