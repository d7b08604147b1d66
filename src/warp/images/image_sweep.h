// Finds the depth of what a surface shows. A reflection moves between views like the thing that it shows, at the depth
// of its image, not like the mirror. Within a block of pixels that show one surface, the views are compared at depths
// in front of it and behind it, patch by patch, as in stereo matching by a plane sweep (R. Collins, "A space-sweep
// approach to true multi-image matching", 1996).
#pragma once

#include "base/grid.h"
#include "base/parallel.h"
#include "warp/images/matched_view.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// The result for the patch around a pixel. Differences are mean squares over the patch, of R, G and B together, and
// over the three best of four views, because one view may see something else there.
struct ImageMatch {
    bool surface = false; // it shows the surface of its block, and the views can be compared
    // one depth explains the views, and better by a clear margin than the surface's depth
    bool found = false;
    float depth = 0; // disparity, pixels; below 0: rays meet behind the camera
    // of what the pixel shows, even if that is not the surface of its block; NaN: unknown
    float own_depth = std::numeric_limits<float>::quiet_NaN();
    float at_surface = 0; // the difference if the picture lay on the surface
};

class ImageSweep {
public:
    // The first view is the centre. `unit`: motion_unit() (kernels/warp_rules.h).
    ImageSweep(std::span<MatchedView> views, double unit) : views_(views), unit_(unit) {}

    std::span<const MatchedView> views() const { return views_; }
    double unit() const { return unit_; }

    // Calls work(i) for i in [0, count), `at_once` of them in parallel. In between, the views free what was made of
    // them if it is much. So work on neighbouring parts of the picture should have neighbouring numbers.
    template <typename Work>
    void go_through(std::size_t count, std::size_t at_once, const Work &work) const {
        for (std::size_t first = 0; first < count; first += at_once) {
            parallel_for(std::min(at_once, count - first), [&](std::size_t n) { work(first + n); });
            make_room();
        }
    }

    // Whether a block of the centre view has more depths to try than are tried one by one.
    bool has_many_depths(const Imath::Box2i &block) const;

    // Searches the pixels of a block of at most 8 x 8, row by row. If the block has many depths and guesses are given,
    // only depths near a guess are tried.
    std::vector<ImageMatch> search(const Imath::Box2i &block,
                                   const std::optional<std::vector<float>> &guesses = {}) const;

    // Returns refined depths of the pixels of a block, near the depths that depth_at(pixel) gives for them and the
    // pixels around, which may differ within a patch; NaN where depth_at() is NaN.
    std::vector<float> refined(const Imath::Box2i &block,
                               const std::function<float(const Imath::V2i &)> &depth_at) const;

    // Returns the difference of each pixel of a block from each rim view, view by view, if what it and the pixels
    // around show lies at the depths that depth_at(pixel) gives, or at the median of these where that is NaN. NaN where
    // too little can be compared.
    std::vector<float> differences(const Imath::Box2i &block,
                                   const std::function<float(const Imath::V2i &)> &depth_at) const;

private:
    void make_room() const;

    std::span<MatchedView> views_;
    double unit_;
};

// Searches for images in all blocks of the centre view that are worth it. If a block has many depths to try, a picture
// of half the size is searched first, which has half as many depths and a quarter of the pixels; then only depths near
// those found there are tried.

// Calls visit(tile) for the tiles around a tile.
template <typename Visit>
void for_each_beside(const Tiles<> &tiles, std::size_t tile, const Visit &visit) {
    const int column = int(tile) % tiles.columns(), row = int(tile) / tiles.columns();
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, tiles.rows() - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, tiles.columns() - 1); ++c)
            if (c != column || r != row) visit(std::size_t(r * tiles.columns() + c));
}

// The depths found in a picture, for its pixels row by row; NaN: nothing was found.
struct ImageGuesses {
    Grid grid;
    std::vector<float> depths; // disparity, in pixels of the picture

    // The depths found near a block of the picture that is twice as large, in pixels of that picture.
    std::vector<float> near(const Imath::Box2i &block) const;
};

// Pixels are numbered block by block, in searched blocks only, because most pictures show few mirrors.
class ImageSearch {
public:
    // Searches these blocks of `data`, and the blocks beside those in which many pixels find a depth.
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
    Tiles<> tiles_;
    std::optional<ImageGuesses> guesses_; // of a picture of half the size, if it was searched
    std::vector<std::uint32_t> blocks_;   // [tile]: its place among the numbered blocks
    std::uint32_t count_ = 0;             // of blocks
};

} // namespace sparselens
