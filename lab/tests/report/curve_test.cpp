#include "lab/report/curve.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace sparselens::lab {
namespace {

const Curve doubling = {{1, 30}, {4, 36}, {16, 42}}; // 3 dB whenever the cost doubles

TEST(Curve, IsSortedAndKeepsTheBestOfACost) {
    const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
    const std::array<CurvePoint, 7> points{
        {{4, 36}, {1, 29}, {1, 30}, {2, nan}, {8, infinity}, {0, 20}, {infinity, 50}}};
    EXPECT_EQ(curve_of(points), (Curve{{1, 30}, {4, 36}}));
    EXPECT_TRUE(curve_of({}).empty());
}

TEST(Curve, IsLinearInTheLogarithmOfCost) {
    EXPECT_NEAR(*quality_at(doubling, 2), 33, 1e-12);
    EXPECT_NEAR(*quality_at(doubling, 8), 39, 1e-12);
    EXPECT_EQ(*quality_at(doubling, 4), 36);
    const Reached reached = reached_at(doubling, 33);
    EXPECT_EQ(reached.bound, Reached::exactly);
    EXPECT_NEAR(reached.cost, 2, 1e-12);
}

TEST(Curve, IsNeverExtrapolated) {
    EXPECT_FALSE(quality_at(doubling, 0.999));
    EXPECT_FALSE(quality_at(doubling, 16.001));
    EXPECT_EQ(*quality_at(doubling, 1), 30);
    EXPECT_EQ(*quality_at(doubling, 16), 42);
    EXPECT_FALSE(quality_at({}, 1));

    EXPECT_EQ(reached_at(doubling, 29).bound, Reached::at_most);
    EXPECT_EQ(reached_at(doubling, 29).cost, 1);
    EXPECT_EQ(reached_at(doubling, 42.001).bound, Reached::beyond);
    EXPECT_EQ(reached_at(doubling, 42.001).cost, 16);
    EXPECT_EQ(reached_at({}, 30).bound, Reached::unknown);
    EXPECT_EQ(reached_at(doubling, std::nan("")).bound, Reached::beyond); // NaN is never reached
}

TEST(Curve, OnePointSaysNoMoreThanItself) {
    const Curve one{{3, 40}};
    EXPECT_EQ(*quality_at(one, 3), 40);
    EXPECT_FALSE(quality_at(one, 2.9));
    EXPECT_EQ(reached_at(one, 40).bound, Reached::exactly);
    EXPECT_EQ(reached_at(one, 39).bound, Reached::at_most);
}

TEST(Curve, ThatFallsCountsFromWhereItFirstReached) {
    const Curve noisy{{1, 30}, {2, 40}, {4, 35}, {8, 45}};
    const Reached reached = reached_at(noisy, 35);
    EXPECT_NEAR(reached.cost, std::sqrt(2), 1e-12);
    EXPECT_NEAR(reached_at(noisy, 42.5).cost, 4 * std::pow(2, 0.75), 1e-12);
}

// Both directions use the same line.
TEST(Curve, QualityAndCostAreInverse) {
    for (double cost = 1; cost <= 16; cost *= 1.1)
        EXPECT_NEAR(reached_at(doubling, *quality_at(doubling, cost)).cost, cost, 1e-9 * cost);
}

} // namespace
} // namespace sparselens::lab
