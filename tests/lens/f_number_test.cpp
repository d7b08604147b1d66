#include "lens/thin_lens.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

TEST(FNumber, IsTheFocalLengthOverTheDiameter) {
    EXPECT_DOUBLE_EQ(radius_of(2.5, 50), 0.01); // 50 mm / 2.5 is 20 mm across
    EXPECT_DOUBLE_EQ(fstop_of(0.01, 50), 2.5);
}

TEST(FNumber, TheRadiusIsInSceneUnits) {
    EXPECT_DOUBLE_EQ(radius_of(2.5, 50, 0.01), 1); // centimetres
    EXPECT_DOUBLE_EQ(fstop_of(1, 50, 0.01), 2.5);
}

TEST(FNumber, APinholeHasAnInfiniteOne) {
    EXPECT_EQ(radius_of(inf, 50), 0);
    EXPECT_EQ(fstop_of(0, 50), inf);
}

TEST(FNumber, BackAndForth) {
    for (const double fstop : {0.7, 1.4, 5.6, 22.0})
        for (const double unit : {1e-3, 0.0254, 1.0})
            EXPECT_DOUBLE_EQ(fstop_of(radius_of(fstop, 35, unit), 35, unit), fstop);
}

} // namespace
} // namespace sparselens
