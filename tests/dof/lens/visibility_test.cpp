// The samples that a lens point sees in a tile, by closed forms.
#include "visibility_fixture.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using Samples = std::vector<Sample>;

// The number of pixels in the tile that show `key(x, y)`.
template <typename Key>
int count_shown(const Visibility &seen, const Key &key) {
    int count = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) count += seen.shown()[tile_cells::at(x, y)] == key(x, y);
    return count;
}
int count_empty(const Visibility &seen) {
    int count = 0;
    seen.for_each_empty([&](std::size_t) { ++count; });
    return count;
}

TEST(VisibilityPass, WhatIsInFocusIsSeenWhereItIs) {
    const TileFixture tile([](int, int) { return Samples{opaque_at(0)}; }, {{.75f, -.5f, .4f, -.4f, 1}});
    const GatherScene scene = tile.scene();
    const TileTask task = tile.task();
    VisibilityPass visibility(scene, task);
    const Visibility &seen = visibility.through(tile.points[0]);
    EXPECT_EQ(count_shown(seen, [&](int x, int y) { return tile.key(x, y); }), 64 * 64);
    EXPECT_EQ(count_empty(seen), 0);
}

TEST(VisibilityPass, WhatIsOutOfFocusIsSeenAsFarAwayAsItsCircleIsWide) {
    const TileFixture tile(
        [](int x, int y) { return x == 10 && y == 20 ? Samples{opaque_at(-4)} : Samples{}; },
        {{.75f, -.5f, 0, 0, 1}});
    const GatherScene scene = tile.scene();
    const TileTask task = tile.task();
    VisibilityPass visibility(scene, task);
    const Visibility &seen = visibility.through(tile.points[0]);
    EXPECT_EQ(seen.front[tile_cells::at(10 - 3, 20 + 2)], tile.key(10, 20));
    EXPECT_EQ(count_shown(seen, [&](int, int) { return tile.key(10, 20); }), 1);
}

TEST(VisibilityPass, TheNearerOfTwoSurfacesIsInFront) {
    const auto near = [](int x, int y) { return x == 30 && y == 30; };
    const TileFixture tile([&](int x, int y) { return Samples{near(x, y) ? opaque_at(-6) : opaque_at(0)}; },
                           {{.5f, .5f, 0, 0, 1}});
    const GatherScene scene = tile.scene();
    const TileTask task = tile.task();
    VisibilityPass visibility(scene, task);
    const Visibility &seen = visibility.through(tile.points[0]);
    EXPECT_EQ(seen.front[tile_cells::at(27, 27)], tile.key(30, 30));
    EXPECT_EQ(count_shown(seen, [&](int x, int y) { return tile.key(x, y); }), 64 * 64 - 2);
    EXPECT_EQ(count_empty(seen), 1); // no view saw what was hidden at (30, 30)
    EXPECT_EQ(seen.empty[30], std::uint64_t{1} << 30);
}

// Two columns of one surface, seen at 16.7 and 18.1: the pixel between them shows the farther.
TEST(VisibilityPass, ASurfaceShowsThroughTheCracksBetweenItsSamples) {
    const TileFixture tile([](int x, int) { return Samples{opaque_at(x <= 10 ? 6 : 6.4)}; },
                           {{1, 0, .2f, 0, 1}});
    const GatherScene scene = tile.scene();
    const TileTask task = tile.task();
    VisibilityPass visibility(scene, task);
    const Visibility &seen = visibility.through(tile.points[0]);
    for (const int y : {0, 31, 63}) {
        EXPECT_EQ(seen.front[tile_cells::at(16, y)], tile.key(10, y));
        EXPECT_EQ(seen.front[tile_cells::at(17, y)], tile.key(11, y));
        EXPECT_EQ(seen.front[tile_cells::at(18, y)], tile.key(11, y));
        EXPECT_EQ(seen.front[tile_cells::at(19, y)], tile.key(12, y));
        EXPECT_FALSE(seen.empty[std::size_t(y)] >> 17 & 1);
    }
}

// The same columns before a ground in every pixel. A ground far behind does not show between them.
TEST(VisibilityPass, ASurfaceShowsThroughItsCracksBeforeWhatIsFarBehind) {
    for (const double behind : {0.9, 1.1, 6.0}) {
        const TileFixture tile(
            [&](int x, int) {
                return Samples{opaque_at(x <= 10 ? 1 : 1.4), opaque_at(1.4 + behind)};
            },
            {{1, 0, .2f, 0, 1}});
        const GatherScene scene = tile.scene();
        const TileTask task = tile.task();
        VisibilityPass visibility(scene, task);
        const Visibility &seen = visibility.through(tile.points[0]);
        EXPECT_EQ(seen.front[tile_cells::at(11, 31)], tile.key(10, 31));
        EXPECT_EQ(seen.front[tile_cells::at(12, 31)] == tile.key(11, 31), behind > 1) << behind;
        EXPECT_EQ(seen.front[tile_cells::at(13, 31)], tile.key(11, 31));
    }
}

// A gap in the picture is not closed: the posts on either side are not neighbours.
TEST(VisibilityPass, NothingClosesAGapThatThePictureShows) {
    const TileFixture tile([](int x, int) { return x % 2 ? Samples{opaque_at(-6)} : Samples{opaque_at(6)}; },
                           {{0, 0, 0, 0, 1}});
    const GatherScene scene = tile.scene();
    const TileTask task = tile.task();
    VisibilityPass visibility(scene, task);
    const Visibility &seen = visibility.through(tile.points[0]);
    EXPECT_EQ(count_shown(seen, [&](int x, int y) { return tile.key(x, y); }), 64 * 64);
}

// A mirror in focus: its surface stays in place, and its image of CoC 6 moves inside it by 3 pixels.
TEST(VisibilityPass, AMirrorShowsWhatItShowsWhereItIs) {
    const TileFixture tile(
        [](int, int) {
            Sample sample = opaque_at(0);
            sample.image_z = depth_of(TileFixture::lens, 6);
            return Samples{sample};
        },
        {{.5f, 0, 0, 0, 1}});
    const GatherScene scene = tile.scene();
    const TileTask task = tile.task();
    VisibilityPass visibility(scene, task);
    const Visibility &seen = visibility.through(tile.points[0]);
    // The column to the left of the first image shows that image; the columns farther left show the mirror.
    EXPECT_EQ(count_shown(seen, [&](int x, int y) { return tile.key(std::max(x - 3, x < 2 ? x : 0), y); }),
              64 * 64);
    EXPECT_EQ(seen.front[tile_cells::at(40, 50)], tile.key(40, 50));
    EXPECT_EQ(seen.shown()[tile_cells::at(40, 50)], tile.key(37, 50));
}

TEST(VisibilityPass, PartialSamplesAreFrontToBackWhereverTheyLie) {
    const TileFixture tile(
        [](int x, int y) {
            return x == 20 && y == 20 ? Samples{partial_at(-2, .25f), partial_at(4, .5f), opaque_at(6)}
                                      : Samples{};
        },
        {{.5f, 0, 0, 0, 1}});
    const GatherScene scene = tile.scene();
    const TileTask task = tile.task();
    VisibilityPass visibility(scene, task);
    const Visibility &seen = visibility.through(tile.points[0]);
    ASSERT_EQ(seen.partial.count(), 2u);
    EXPECT_EQ(seen.partial.key, (std::vector{tile.key(20, 20, 0), tile.key(20, 20, 1)}));
    EXPECT_EQ(seen.partial.left, (std::vector{.75f, .5f}));
    EXPECT_EQ(seen.partial_cells,
              (std::vector{std::int32_t(tile_cells::at(19, 20)), std::int32_t(tile_cells::at(22, 20))}));
    EXPECT_EQ(seen.front[tile_cells::at(23, 20)], tile.key(20, 20, 2));
}

} // namespace
} // namespace sparselens
