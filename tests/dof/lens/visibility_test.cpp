// The samples that a lens point sees in a tile, by closed forms.
#include "visibility_fixture.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using Samples = std::vector<Sample>;

// The number of pixels in the tile that show `sample(x, y)`.
template <typename SampleAt>
int count_shown(const Seen &seen, const SampleAt &sample) {
    int count = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) count += seen.shown(x, y) == sample(x, y);
    return count;
}
int count_unknown(const Seen &seen) {
    int count = 0;
    seen.by_point.for_each_unknown([&](std::size_t) { ++count; });
    return count;
}

TEST(VisibilityPass, WhatIsInFocusIsSeenWhereItIs) {
    const TileFixture tile([](int, int) { return Samples{opaque_at(0)}; }, {{.75f, -.5f, .4f, -.4f, 1}});
    const Seen seen(tile);
    EXPECT_EQ(count_shown(seen, [&](int x, int y) { return tile.sample(x, y); }), 64 * 64);
    EXPECT_EQ(count_unknown(seen), 0);
}

TEST(VisibilityPass, WhatIsOutOfFocusIsSeenAsFarAwayAsItsCircleIsWide) {
    const TileFixture tile(
        [](int x, int y) { return x == 10 && y == 20 ? Samples{opaque_at(-4)} : Samples{}; },
        {{.75f, -.5f, 0, 0, 1}});
    const Seen seen(tile);
    EXPECT_EQ(seen.front(10 - 3, 20 + 2), tile.sample(10, 20));
    EXPECT_EQ(count_shown(seen, [&](int, int) { return tile.sample(10, 20); }), 1);
}

TEST(VisibilityPass, TheNearerOfTwoSurfacesIsInFront) {
    const auto near = [](int x, int y) { return x == 30 && y == 30; };
    const TileFixture tile([&](int x, int y) { return Samples{near(x, y) ? opaque_at(-6) : opaque_at(0)}; },
                           {{.5f, .5f, 0, 0, 1}});
    const Seen seen(tile);
    EXPECT_EQ(seen.front(27, 27), tile.sample(30, 30));
    EXPECT_EQ(count_shown(seen, [&](int x, int y) { return tile.sample(x, y); }), 64 * 64 - 2);
    EXPECT_EQ(count_unknown(seen), 1); // no view saw what was hidden at (30, 30)
    EXPECT_EQ(seen.by_point.unknown[30], std::uint64_t{1} << 30);
}

// Two columns of one surface, seen at 16.7 and 18.1: the pixel between them shows the farther.
TEST(VisibilityPass, ASurfaceShowsThroughTheCracksBetweenItsSamples) {
    const TileFixture tile([](int x, int) { return Samples{opaque_at(x <= 10 ? 6 : 6.4)}; },
                           {{1, 0, .2f, 0, 1}});
    const Seen seen(tile);
    for (const int y : {0, 31, 63}) {
        EXPECT_EQ(seen.front(16, y), tile.sample(10, y));
        EXPECT_EQ(seen.front(17, y), tile.sample(11, y));
        EXPECT_EQ(seen.front(18, y), tile.sample(11, y));
        EXPECT_EQ(seen.front(19, y), tile.sample(12, y));
        EXPECT_FALSE(seen.by_point.unknown[std::size_t(y)] >> 17 & 1);
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
        const Seen seen(tile);
        EXPECT_EQ(seen.front(11, 31), tile.sample(10, 31));
        EXPECT_EQ(seen.front(12, 31) == tile.sample(11, 31), behind > 1) << behind;
        EXPECT_EQ(seen.front(13, 31), tile.sample(11, 31));
    }
}

// A gap in the picture is not closed: the posts on either side are not neighbours.
TEST(VisibilityPass, NothingClosesAGapThatThePictureShows) {
    const TileFixture tile([](int x, int) { return x % 2 ? Samples{opaque_at(-6)} : Samples{opaque_at(6)}; },
                           {{0, 0, 0, 0, 1}});
    const Seen seen(tile);
    EXPECT_EQ(count_shown(seen, [&](int x, int y) { return tile.sample(x, y); }), 64 * 64);
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
    const Seen seen(tile);
    // The column to the left of the first image shows that image; the columns farther left show the mirror.
    EXPECT_EQ(count_shown(seen, [&](int x, int y) { return tile.sample(std::max(x - 3, x < 2 ? x : 0), y); }),
              64 * 64);
    EXPECT_EQ(seen.front(40, 50), tile.sample(40, 50));
    EXPECT_EQ(seen.shown(40, 50), tile.sample(37, 50));
}

TEST(VisibilityPass, PartialSamplesAreFrontToBackWhereverTheyLie) {
    const TileFixture tile(
        [](int x, int y) {
            return x == 20 && y == 20 ? Samples{partial_at(-2, .25f), partial_at(4, .5f), opaque_at(6)}
                                      : Samples{};
        },
        {{.5f, 0, 0, 0, 1}});
    const Seen seen(tile);
    const PartialSamples &partial = seen.visibility.samples().partial;
    ASSERT_EQ(partial.count(), 2u);
    EXPECT_EQ(partial.sample, (std::vector{tile.sample(20, 20, 0), tile.sample(20, 20, 1)}));
    EXPECT_EQ(partial.left, (std::vector{.75f, .5f}));
    EXPECT_EQ(seen.by_point.partial_cells[0], tile_cells::at(19, 20));
    EXPECT_EQ(seen.by_point.partial_cells[1], tile_cells::at(22, 20));
    EXPECT_EQ(seen.front(23, 20), tile.sample(20, 20, 2));
}

} // namespace
} // namespace sparselens
