#include "lab/trace/materials.h"

#include <gtest/gtest.h>

namespace sparselens::lab {
namespace {

// Computed independently of the code, in unbounded integers: numerators over 2^24.
TEST(Materials, HashBits) {
    EXPECT_EQ(hash(0, 0, 0), 0);
    EXPECT_EQ(hash(1, 0, 0) * 0x1p24, 7712859);
    EXPECT_EQ(hash(0, 1, 2) * 0x1p24, 7756041);
    EXPECT_EQ(hash(-1, 0, 7) * 0x1p24, 1453189);
    EXPECT_EQ(hash(13, -5, 7) * 0x1p24, 4793919);
    EXPECT_EQ(hash(-48, 33, -2) * 0x1p24, 12103518);
    EXPECT_EQ(hash(199, 4, 4) * 0x1p24, 5292316);
}

TEST(Materials, FloorTilesAreHalfAUnitWide) {
    EXPECT_EQ(floor_tiles({0.2, -1, 0.7}).colour, Imath::C3f(0.8f, 0.75f, 0.7f));  // cell (0, 1)
    EXPECT_EQ(floor_tiles({0.2, -1, 0.2}).colour, Imath::C3f(0.15f, 0.2f, 0.25f)); // cell (0, 0), hash 0
    EXPECT_EQ(floor_tiles({-0.1, -1, 0.2}).colour, Imath::C3f(0.8f, 0.75f, 0.7f)); // cell (-1, 0)
    EXPECT_FLOAT_EQ(floor_tiles({1.1, -1, 1.2}).colour.x, float(0.15 + 0.2 * hash(2, 0, 2)));
}

TEST(Materials, WallTilesAreAQuarterWide) {
    EXPECT_EQ(wall_tiles({-0.1, 0.1, 18}).colour, Imath::C3f(0.2f, float(0.5 * 1453189 * 0x1p-24), 0.7f));
    EXPECT_EQ(wall_tiles({0.3, 0.3, 18}).colour, Imath::C3f(0.9f, float(0.6 + 0.3 * hash(1, 1, 7)), 0.2f));
}

TEST(Materials, DotsAndStripesFollowTheirSigns) {
    EXPECT_EQ(dots({0.01, 0.01, 0.01}).colour, Imath::C3f(0.9f, 0.2f, 0.15f));
    EXPECT_EQ(dots({-0.01, 0.01, 0.01}).colour, Imath::C3f(0.95f, 0.9f, 0.85f));
    EXPECT_EQ(stripes({0, 0.01, 3}).colour, Imath::C3f(0.1f, 0.6f, 0.2f));
    EXPECT_EQ(stripes({0, -0.01, 3}).colour, Imath::C3f(0.6f, 0.8f, 0.3f));
    EXPECT_EQ(stripes({-0.06, 0.01, 3}).colour, Imath::C3f(0.6f, 0.8f, 0.3f));
}

TEST(Materials, OnlyLampsEmit) {
    EXPECT_TRUE(lamp({0, 0, 0}).emits);
    EXPECT_EQ(lamp({0, 0, 0}).colour, Imath::C3f(60, 48, 30));
    EXPECT_FALSE(dark({0, 0, 0}).emits);
    EXPECT_EQ(dark({0, 0, 0}).colour, Imath::C3f(0.05f, 0.05f, 0.06f));
}

} // namespace
} // namespace sparselens::lab
