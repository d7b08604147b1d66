// The pixels of a rectangle, counted row by row, and rectangles cut into tiles. Coordinates are converted to an index,
// and back, only here. Both are checked in debug builds.
#pragma once

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace sparselens {

// The number of pieces of at most `size` (> 0) that cover `length` (>= 0).
template <typename Count>
constexpr Count pieces_of(Count length, Count size) {
    return (length + size - 1) / size;
}

// The pixels that are in both boxes; isEmpty() if there are none.
inline Imath::Box2i common_box(const Imath::Box2i &a, const Imath::Box2i &b) {
    return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)},
            {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)}};
}

class Grid {
public:
    Grid() = default;                                               // no pixels
    Grid(int width, int height) : width_(width), height_(height) {} // [0, width) x [0, height)
    explicit Grid(const Imath::Box2i &box)                          // max inclusive
        : corner_(box.min), width_(box.max.x - box.min.x + 1), height_(box.max.y - box.min.y + 1) {}

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t size() const { return std::size_t(width_) * std::size_t(height_); }
    Imath::Box2i box() const { return {corner_, corner_ + Imath::V2i(width_ - 1, height_ - 1)}; }

    bool contains(int x, int y) const {
        return x >= corner_.x && y >= corner_.y && x - corner_.x < width_ && y - corner_.y < height_;
    }
    std::size_t index(int x, int y) const {
        assert(contains(x, y));
        return std::size_t(y - corner_.y) * std::size_t(width_) + std::size_t(x - corner_.x);
    }
    // The pixel with this index.
    Imath::V2i pixel(std::size_t index) const {
        assert(index < size());
        return corner_ + Imath::V2i(int(index % std::size_t(width_)), int(index / std::size_t(width_)));
    }

private:
    Imath::V2i corner_{0, 0};
    int width_ = 0, height_ = 0;
};

// A box cut into tiles, counted row by row from its upper left corner. Tiles at the right and lower edge may be
// smaller.
class Tiles {
public:
    Tiles(const Imath::Box2i &box, int width, int height) // size of a tile, > 0
        : box_(box), width_(width), height_(height),
          grid_(pieces_of(Grid(box).width(), width), pieces_of(Grid(box).height(), height)) {}
    Tiles(const Imath::Box2i &box, int size) : Tiles(box, size, size) {}

    int columns() const { return grid_.width(); }
    int rows() const { return grid_.height(); }
    std::size_t count() const { return grid_.size(); }

    // The pixels of a tile, max inclusive.
    Imath::Box2i box(int column, int row) const {
        assert(grid_.contains(column, row));
        const Imath::V2i first = box_.min + Imath::V2i(column * width_, row * height_);
        return {first,
                {std::min(first.x + width_ - 1, box_.max.x), std::min(first.y + height_ - 1, box_.max.y)}};
    }
    Imath::Box2i box(std::size_t tile) const {
        const Imath::V2i at = grid_.pixel(tile);
        return box(at.x, at.y);
    }
    // The tile that holds a pixel of the box.
    std::size_t tile_of(const Imath::V2i &pixel) const {
        return grid_.index((pixel.x - box_.min.x) / width_, (pixel.y - box_.min.y) / height_);
    }

private:
    Imath::Box2i box_;
    int width_, height_;
    Grid grid_; // of tiles
};

} // namespace sparselens
