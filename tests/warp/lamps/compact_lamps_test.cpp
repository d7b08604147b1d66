#include "warp/lamps/lamp_light.h"

#include <gtest/gtest.h>

#include <functional>

namespace sparselens {
namespace {

// A wall of brightness 1 with some shining pixels.
std::vector<CompactLamp> found(const std::function<float(int x, int y)> &shine) {
    const Grid grid(Imath::Box2i({-7, 3}, {56, 50}));
    std::vector<float> brightness;
    for (std::size_t i = 0; i < grid.size(); ++i)
        brightness.push_back(1 + shine(grid.pixel(i).x, grid.pixel(i).y));
    return find_compact_lamps(grid, brightness);
}

TEST(CompactLamps, AreGroupsOfBrightPixelsTheBrightestFirst) {
    const auto lamps = found([](int x, int y) {
        if (x == 20 && y == 20) return 100.0f;
        if (x == 23 && y == 21) return 50.0f;    // within lamp_gap
        if (x == 27 && y == 20) return 60.0f;    // farther
        if (x == -7 && y == 50) return 9.0f;     // in a corner
        return x == 40 && y == 40 ? 6.0f : 0.0f; // too dark
    });
    ASSERT_EQ(lamps.size(), 3u);
    EXPECT_EQ(lamps[0].pixels, (std::vector<Imath::V2i>{{20, 20}, {23, 21}}));
    EXPECT_EQ(lamps[1].pixels, (std::vector<Imath::V2i>{{27, 20}}));
    EXPECT_EQ(lamps[2].pixels, (std::vector<Imath::V2i>{{-7, 50}}));
    EXPECT_EQ(lamps[0].surroundings, 1);
    EXPECT_EQ(lamps[0].limit, 4);
}

TEST(CompactLamps, AreNotLarge) {
    for (const int size : {12, 13}) {
        const auto lamps =
            found([&](int x, int y) { return x >= 9 && x < 9 + size && y >= 20 && y < 22 ? 100.0f : 0.0f; });
        ASSERT_EQ(lamps.size(), size == 12 ? 1u : 0u);
        EXPECT_TRUE(lamps.empty() || lamps[0].pixels.size() == 24);
    }
    // The rest of a large group is not a lamp.
    EXPECT_TRUE(found([](int x, int) { return x > 30 && x < 37 ? 100.0f : 0.0f; }).empty());
}

TEST(CompactLamps, AreNotWhereNothingStandsOut) {
    EXPECT_TRUE(found([](int, int) { return 0.0f; }).empty());
    EXPECT_TRUE(found([](int x, int y) { return float((x * 31 + y * 17) & 7); }).empty());
    EXPECT_TRUE(found([](int x, int) { return x > 20 ? 100.0f : 0.0f; }).empty()); // half is bright
}

} // namespace
} // namespace sparselens
