#include "base/grid.h"

#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

namespace sparselens {
namespace {

using Imath::Box2i;
using Imath::V2i;

// Whether a grid takes such a place.
template <typename Counted, typename... Place>
concept Takes = requires(const Counted &grid, Place... place) {
    grid.index(place...);
};
template <typename Box, typename Place>
concept Holds = requires(const Tiles<Box> &tiles, Place place) {
    tiles.tile_of(place);
};

// No place becomes one of the other kind unless grid.position() or grid.pixel() is called.
static_assert(Takes<Grid, V2i> && Takes<Grid, Position> && Takes<ArrayGrid, Position>);
static_assert(!Takes<ArrayGrid, V2i> && !Takes<Grid, int, int> && !Takes<ArrayGrid, int, int>);
static_assert(!Takes<Grid, Imath::V2d>);
static_assert(Holds<Box2i, V2i> && Holds<PositionBox, Position>);
static_assert(!Holds<Box2i, Position> && !Holds<PositionBox, V2i>);
static_assert(!std::is_convertible_v<V2i, Position> && !std::is_constructible_v<V2i, Position>);
static_assert(!std::is_convertible_v<Box2i, PositionBox> && !std::is_convertible_v<PositionBox, Box2i>);
static_assert(!std::is_constructible_v<Grid, int, int> && !std::is_constructible_v<ArrayGrid, Box2i>);
static_assert(!std::is_convertible_v<Grid, ArrayGrid> && !std::is_convertible_v<ArrayGrid, Grid>);

TEST(ArrayGrid, CountsPositionsRowByRow) {
    const ArrayGrid grid(4, 3);
    EXPECT_EQ(grid.width(), 4);
    EXPECT_EQ(grid.height(), 3);
    EXPECT_EQ(grid.size(), 12u);
    EXPECT_EQ(grid.box(), (PositionBox{Position(0, 0), Position(3, 2)}));
    EXPECT_EQ(grid.index(Position(0, 0)), 0u);
    EXPECT_EQ(grid.index(Position(3, 0)), 3u);
    EXPECT_EQ(grid.index(Position(0, 1)), 4u);
    EXPECT_EQ(grid.index(Position(3, 2)), 11u);
    for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_EQ(grid.index(grid.position(i)), i);
}

TEST(ArrayGrid, ContainsItsEdgesAndNothingBeyond) {
    const ArrayGrid grid(2, 3);
    for (int row = -2; row <= 4; ++row)
        for (int column = -2; column <= 4; ++column)
            EXPECT_EQ(grid.contains(Position(column, row)),
                      column >= 0 && column <= 1 && row >= 0 && row <= 2);
    EXPECT_FALSE(ArrayGrid().contains(Position(0, 0)));
}

TEST(Grid, TurnsPixelsIntoPositionsAndBack) {
    const Grid grid(Box2i({-5, 7}, {-3, 8}));
    EXPECT_EQ(grid.position(V2i(-5, 7)), Position(0, 0));
    EXPECT_EQ(grid.position(V2i(-3, 8)), Position(2, 1));
    EXPECT_EQ(grid.pixel(Position(2, 1)), V2i(-3, 8));
    EXPECT_EQ(grid.index(Position(2, 1)), grid.index(V2i(-3, 8)));
    EXPECT_TRUE(grid.contains(Position(2, 1)));
    EXPECT_FALSE(grid.contains(V2i(2, 1)));
}

TEST(Grid, StartsWhereItsBoxDoes) {
    const Box2i box({-5, 7}, {-3, 8});
    const Grid grid(box);
    EXPECT_EQ(grid.box(), box);
    EXPECT_EQ(grid.size(), 6u);
    EXPECT_EQ(grid.index(V2i(-5, 7)), 0u);
    EXPECT_EQ(grid.index(V2i(-4, 8)), 4u);
    EXPECT_EQ(grid.pixel(2), V2i(-3, 7));
}

TEST(Grid, PixelIsTheInverseOfIndex) {
    const Grid grid(Box2i({-2, -3}, {4, 1}));
    std::size_t expected = 0;
    for (int y = -3; y <= 1; ++y)
        for (int x = -2; x <= 4; ++x, ++expected) {
            EXPECT_EQ(grid.index(V2i(x, y)), expected);
            EXPECT_EQ(grid.pixel(expected), V2i(x, y));
        }
    EXPECT_EQ(expected, grid.size());
}

TEST(Grid, ContainsItsEdgesAndNothingBeyond) {
    const Grid grid(Box2i({-1, 2}, {1, 3}));
    for (int y = 0; y <= 5; ++y)
        for (int x = -3; x <= 3; ++x)
            EXPECT_EQ(grid.contains(V2i(x, y)), x >= -1 && x <= 1 && y >= 2 && y <= 3) << x << "," << y;
    EXPECT_FALSE(Grid().contains(V2i(0, 0)));
    EXPECT_EQ(Grid().size(), 0u);
}

TEST(ArrayGrid, IndicesDoNotOverflow) {
    const ArrayGrid grid(100'000, 100'000);
    EXPECT_EQ(grid.index(Position(99'999, 99'999)), 9'999'999'999u);
    EXPECT_EQ(grid.position(9'999'999'999u), Position(99'999, 99'999));
}

TEST(Pieces, TheLastMayBeShorter) {
    EXPECT_EQ(pieces_of(0, 8), 0);
    EXPECT_EQ(pieces_of(1, 8), 1);
    EXPECT_EQ(pieces_of(8, 8), 1);
    EXPECT_EQ(pieces_of(9, 8), 2);
    EXPECT_EQ(pieces_of(std::size_t(17), std::size_t(8)), 3u);
}

TEST(Tiles, AreCountedRowByRowAndCutOffAtTheEdges) {
    const Tiles tiles(Box2i({10, 20}, {19, 24}), 4, 3);
    EXPECT_EQ(tiles.columns(), 3);
    EXPECT_EQ(tiles.rows(), 2);
    EXPECT_EQ(tiles.count(), 6u);
    EXPECT_EQ(tiles.box(0), Box2i({10, 20}, {13, 22}));
    EXPECT_EQ(tiles.box(2), Box2i({18, 20}, {19, 22}));
    EXPECT_EQ(tiles.box(5), Box2i({18, 23}, {19, 24}));
    EXPECT_EQ(tiles.box(Position(2, 1)), tiles.box(5));
}

TEST(Tiles, AreOneWhereTheBoxIsNoLarger) {
    const Tiles tiles(Box2i({0, 0}, {7, 7}), 8);
    EXPECT_EQ(tiles.count(), 1u);
    EXPECT_EQ(tiles.box(0), Box2i({0, 0}, {7, 7}));
    EXPECT_EQ(Tiles(Box2i({0, 0}, {-1, -1}), 8).count(), 0u);
}

TEST(Tiles, OfPositionsAreThoseOfPixels) {
    const Box2i box({-7, 3}, {22, 16});
    const Grid grid(box);
    const Tiles of_pixels(box, 8, 5);
    const Tiles of_positions(grid.array().box(), 8, 5);
    ASSERT_EQ(of_positions.count(), of_pixels.count());
    for (std::size_t tile = 0; tile < of_pixels.count(); ++tile) {
        const PositionBox part = of_positions.box(tile);
        EXPECT_EQ(Box2i(grid.pixel(part.min), grid.pixel(part.max)), of_pixels.box(tile));
        EXPECT_EQ(of_positions.tile_of(part.max), tile);
        EXPECT_TRUE(part.contains(part.max));
        EXPECT_FALSE(part.contains(part.max + V2i(1, 0)));
    }
}

TEST(Tiles, HoldEveryPixelOnce) {
    const Box2i box({-7, 3}, {22, 16});
    const Grid grid(box);
    for (const int size : {1, 3, 5, 14, 15, 30, 31}) {
        const Tiles tiles(box, size);
        std::vector<int> held(grid.size(), 0);
        for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
            const Box2i part = tiles.box(tile);
            for (int y = part.min.y; y <= part.max.y; ++y)
                for (int x = part.min.x; x <= part.max.x; ++x) {
                    ++held[grid.index(V2i(x, y))];
                    EXPECT_EQ(tiles.tile_of({x, y}), tile);
                }
        }
        EXPECT_EQ(held, std::vector<int>(grid.size(), 1)) << size;
    }
}

} // namespace
} // namespace sparselens
