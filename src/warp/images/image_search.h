// Searches for images in all blocks of the centre view that are worth it. If a block has many depths to try, a picture
// of half the size is searched first, which has half as many depths and a quarter of the pixels; then only depths near
// those found there are tried.
#pragma once

#include "base/grid.h"
#include "warp/images/image_sweep.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace sparselens {

// Calls visit(tile) for the tiles around a tile.
template <typename Visit>
void for_each_beside(const Tiles &tiles, std::size_t tile, const Visit &visit) {
    const int column = int(tile) % tiles.columns(), row = int(tile) / tiles.columns();
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, tiles.rows() - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, tiles.columns() - 1); ++c)
            if (c != column || r != row) visit(std::size_t(r * tiles.columns() + c));
}

// The depths found in a picture, for its pixels row by row; NaN: nothing was found.
struct ImageGuesses {
    Grid grid;
    std::vector<float> depths; // perceptive, in pixels of the picture

    // The depths found near a block of the picture that is twice as large, in pixels of that picture.
    std::vector<float> near(const Imath::Box2i &block) const;
};

// Pixels are numbered block by block, in searched blocks only, because most pictures show few mirrors.
class ImageSearch {
public:
    // Searches these blocks of `data`, and blocks beside which it has found something.
    ImageSearch(const ImageSweep &sweep, const Imath::Box2i &data, const std::vector<std::size_t> &blocks);

    const ImageSweep &sweep() const { return sweep_; }
    const Imath::Box2i &box() const { return box_; }
    // The number of a pixel; npos if it was not searched or lies outside.
    std::size_t index_of(const Imath::V2i &pixel) const;
    // The results, by the number of the pixel.
    std::vector<ImageMatch> matches;

    // The number of bands of the data window, each of `rows` rows of blocks.
    std::size_t bands(std::size_t rows) const { return pieces_of(std::size_t(tiles_.rows()), rows); }
    // Calls visit(block) for the blocks of a band that were searched.
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
    std::optional<ImageGuesses> guesses_; // of a picture of half the size, if it was searched
    std::vector<std::uint32_t> blocks_;   // [tile]: its place among the numbered blocks
    std::uint32_t count_ = 0;             // of blocks
};

} // namespace sparselens
