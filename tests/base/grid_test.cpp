#include "base/grid.h"

#include <gtest/gtest.h>

#include <vector>

namespace sparselens {
namespace {

using Imath::Box2i;
using Imath::V2i;

TEST(Grid, CountsPixelsRowByRow) {
    const Grid grid(4, 3);
    EXPECT_EQ(grid.width(), 4);
    EXPECT_EQ(grid.height(), 3);
    EXPECT_EQ(grid.size(), 12u);
    EXPECT_EQ(grid.box(), Box2i({0, 0}, {3, 2}));
    EXPECT_EQ(grid.index(0, 0), 0u);
    EXPECT_EQ(grid.index(3, 0), 3u);
    EXPECT_EQ(grid.index(0, 1), 4u);
    EXPECT_EQ(grid.index(3, 2), 11u);
}

TEST(Grid, StartsWhereItsBoxDoes) {
    const Box2i box({-5, 7}, {-3, 8});
    const Grid grid(box);
    EXPECT_EQ(grid.box(), box);
    EXPECT_EQ(grid.size(), 6u);
    EXPECT_EQ(grid.index(-5, 7), 0u);
    EXPECT_EQ(grid.index(-4, 8), 4u);
    EXPECT_EQ(grid.pixel(2), V2i(-3, 7));
}

TEST(Grid, PixelIsTheInverseOfIndex) {
    const Grid grid(Box2i({-2, -3}, {4, 1}));
    std::size_t expected = 0;
    for (int y = -3; y <= 1; ++y)
        for (int x = -2; x <= 4; ++x, ++expected) {
            EXPECT_EQ(grid.index(x, y), expected);
            EXPECT_EQ(grid.pixel(expected), V2i(x, y));
        }
    EXPECT_EQ(expected, grid.size());
}

TEST(Grid, ContainsItsEdgesAndNothingBeyond) {
    const Grid grid(Box2i({-1, 2}, {1, 3}));
    for (int y = 0; y <= 5; ++y)
        for (int x = -3; x <= 3; ++x)
            EXPECT_EQ(grid.contains(x, y), x >= -1 && x <= 1 && y >= 2 && y <= 3) << x << "," << y;
    EXPECT_FALSE(Grid().contains(0, 0));
    EXPECT_EQ(Grid().size(), 0u);
}

TEST(Grid, IndicesDoNotOverflow) {
    const Grid grid(100'000, 100'000);
    EXPECT_EQ(grid.index(99'999, 99'999), 9'999'999'999u);
    EXPECT_EQ(grid.pixel(9'999'999'999u), V2i(99'999, 99'999));
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
    EXPECT_EQ(tiles.box(2, 1), tiles.box(5));
}

TEST(Tiles, AreOneWhereTheBoxIsNoLarger) {
    const Tiles tiles(Box2i({0, 0}, {7, 7}), 8);
    EXPECT_EQ(tiles.count(), 1u);
    EXPECT_EQ(tiles.box(0), Box2i({0, 0}, {7, 7}));
    EXPECT_EQ(Tiles(Box2i({0, 0}, {-1, -1}), 8).count(), 0u);
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
                    ++held[grid.index(x, y)];
                    EXPECT_EQ(tiles.tile_of({x, y}), tile);
                }
        }
        EXPECT_EQ(held, std::vector<int>(grid.size(), 1)) << size;
    }
}

} // namespace
} // namespace sparselens
