#include "lens/thin_lens.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

TEST(SharpRange, EndsWhereTheCircleOfConfusionIsThatLarge) {
    for (const double focus : {0.5, 5.0, 30.0}) {
        const ThinLens lens{0.06, 1000, focus, 1};
        const SharpRange range = sharp_range(lens, 1.5);
        EXPECT_NEAR(circle_of_confusion(lens, range.near), -1.5, 1e-9) << focus;
        EXPECT_NEAR(circle_of_confusion(lens, range.far), 1.5, 1e-9) << focus;
        EXPECT_DOUBLE_EQ(range.hyperfocal, 40);
    }
}

TEST(SharpRange, FromTheHyperfocalDistanceOnInfinityIsSharp) {
    const ThinLens lens{0.06, 1000, 40, 1};
    const SharpRange range = sharp_range(lens, 1.5);
    EXPECT_TRUE(std::isinf(range.far));
    EXPECT_DOUBLE_EQ(range.near, 20);
    EXPECT_NEAR(circle_of_confusion(lens, INFINITY), 1.5, 1e-9);
    const SharpRange at_infinity = sharp_range({0.06, 1000, INFINITY, 1}, 1.5);
    EXPECT_DOUBLE_EQ(at_infinity.near, 40);
    EXPECT_TRUE(std::isinf(at_infinity.far));
}

TEST(SharpRange, OfAPinholeIsEverything) {
    const SharpRange range = sharp_range({0, 1000, 5, 1}, 1);
    EXPECT_EQ(range.near, 0);
    EXPECT_TRUE(std::isinf(range.far));
    EXPECT_EQ(range.hyperfocal, 0);
}

TEST(SharpRange, IsFoundFromItsEnds) {
    for (const double far : {2.5, 10.0, HUGE_VAL}) {
        const FocusFor found = focus_for(2, far);
        const SharpRange range = sharp_range({found.hyperfocal * 1.5 / 1000, 1000, found.focus, 1}, 1.5);
        EXPECT_NEAR(range.near, 2, 1e-12) << far;
        if (std::isinf(far))
            EXPECT_GT(range.far, 1e9);
        else
            EXPECT_NEAR(range.far, far, 1e-9);
    }
    EXPECT_DOUBLE_EQ(focus_for(3, 3).focus, 3);
    EXPECT_TRUE(std::isinf(focus_for(3, 3).hyperfocal));
    EXPECT_TRUE(std::isinf(focus_for(HUGE_VAL, HUGE_VAL).focus)); // what lies at infinity alone
    EXPECT_TRUE(std::isinf(focus_for(HUGE_VAL, HUGE_VAL).hyperfocal));
}

} // namespace
} // namespace sparselens
