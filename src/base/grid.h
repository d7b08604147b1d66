// Pixels of a picture, positions in an array, and boxes of both cut into tiles. Places are converted to an index, and
// back, only here. Both are checked in builds with assertions.
#pragma once

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cassert>
#include <concepts>
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

// A place in an array: its column and row, counted from 0 at the upper left corner. A pixel in EXR coordinates is an
// Imath::V2i. Only Grid turns one into the other, by position() and pixel(). A step from one place to another is an
// Imath::V2i too.
struct Position {
    int column = 0, row = 0;
    constexpr Position() = default;
    constexpr explicit Position(int column_, int row_) : column(column_), row(row_) {}
    Position operator+(const Imath::V2i &step) const { return Position(column + step.x, row + step.y); }
    Position operator-(const Imath::V2i &step) const { return *this + -step; }
    Imath::V2i operator-(const Position &from) const { return {column - from.column, row - from.row}; }
    bool operator==(const Position &) const = default;
};

struct PositionBox { // max inclusive
    Position min, max;
    bool contains(const Position &at) const {
        return at.column >= min.column && at.row >= min.row && at.column <= max.column && at.row <= max.row;
    }
    bool operator==(const PositionBox &) const = default;
};

// The positions of an array, counted row by row.
class ArrayGrid {
public:
    ArrayGrid() = default; // none
    ArrayGrid(int width, int height) : width_(width), height_(height) {}

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t size() const { return std::size_t(width_) * std::size_t(height_); }
    PositionBox box() const { return {Position(0, 0), Position(width_ - 1, height_ - 1)}; }

    bool contains(const Position &at) const { return box().contains(at); }
    std::size_t index(const Position &at) const {
        assert(contains(at));
        return std::size_t(at.row) * std::size_t(width_) + std::size_t(at.column);
    }
    Position position(std::size_t index) const {
        assert(index < size());
        return Position(int(index % std::size_t(width_)), int(index / std::size_t(width_)));
    }

private:
    int width_ = 0, height_ = 0;
};

// The pixels of a box, counted row by row. Pixels are deduced, so that {x, y} does not become one unsaid.
class Grid {
public:
    Grid() = default;                      // no pixels
    explicit Grid(const Imath::Box2i &box) // max inclusive
        : corner_(box.min), array_(box.max.x - box.min.x + 1, box.max.y - box.min.y + 1) {}

    const ArrayGrid &array() const { return array_; }
    int width() const { return array_.width(); }
    int height() const { return array_.height(); }
    std::size_t size() const { return array_.size(); }
    Imath::Box2i box() const { return {corner_, corner_ + Imath::V2i(width() - 1, height() - 1)}; }

    // Where a pixel lies in the array of all, and the reverse.
    Position position(const std::same_as<Imath::V2i> auto &pixel) const {
        return Position(pixel.x - corner_.x, pixel.y - corner_.y);
    }
    Imath::V2i pixel(const Position &at) const { return corner_ + Imath::V2i(at.column, at.row); }

    bool contains(const Position &at) const { return array_.contains(at); }
    bool contains(const std::same_as<Imath::V2i> auto &pixel) const { return box().intersects(pixel); }
    std::size_t index(const Position &at) const { return array_.index(at); }
    std::size_t index(const std::same_as<Imath::V2i> auto &pixel) const { return index(position(pixel)); }
    Imath::V2i pixel(std::size_t index) const { return pixel(array_.position(index)); }

private:
    Imath::V2i corner_{0, 0};
    ArrayGrid array_;
};

// A box of pixels or of positions cut into tiles, counted row by row from its upper left corner. Tiles at the right and
// lower edge may be smaller.
template <typename Box = Imath::Box2i>
class Tiles {
public:
    using Place = decltype(Box::min);

    Tiles(const Box &box, int width, int height) // size of a tile, > 0
        : box_(box), width_(width), height_(height),
          grid_(pieces_of((box.max - box.min)[0] + 1, width), pieces_of((box.max - box.min)[1] + 1, height)) {
    }
    Tiles(const Box &box, int size) : Tiles(box, size, size) {}

    int columns() const { return grid_.width(); }
    int rows() const { return grid_.height(); }
    std::size_t count() const { return grid_.size(); }

    // The places of a tile, max inclusive.
    Box box(const Position &tile) const {
        assert(grid_.contains(tile));
        const Imath::V2i first(tile.column * width_, tile.row * height_), last = box_.max - box_.min;
        return {box_.min + first, box_.min + Imath::V2i(std::min(first.x + width_ - 1, last.x),
                                                        std::min(first.y + height_ - 1, last.y))};
    }
    Box box(std::size_t tile) const { return box(grid_.position(tile)); }
    // The tile that holds a place of the box.
    std::size_t tile_of(const Place &place) const {
        const Imath::V2i at = place - box_.min;
        return grid_.index(Position(at.x / width_, at.y / height_));
    }

private:
    Box box_;
    int width_, height_;
    ArrayGrid grid_;
};

} // namespace sparselens
