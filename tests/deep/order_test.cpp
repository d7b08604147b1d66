#include "support/ldi_samples.h"
#include "support/order.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

// The state of one pixel: "tidy", "sorted", "apart" or "messy". Extents as {z, z_back}.
std::string state_of(const std::vector<std::pair<float, float>> &extents) {
    TestPixel pixel;
    for (const auto &[z, back] : extents) pixel.push_back({.z = z, .z_back = back});
    const Order order = order_of(ldi_of({{{.z = 7}}, pixel, {}}));
    if (order.sorted) return order.apart ? "tidy" : "sorted";
    return order.apart ? "apart" : "messy";
}

TEST(Order, OfPoints) {
    EXPECT_EQ(state_of({}), "tidy");
    EXPECT_EQ(state_of({{1, 1}}), "tidy");
    EXPECT_EQ(state_of({{1, 1}, {2, 2}, {INFINITY, INFINITY}}), "tidy");
    EXPECT_EQ(state_of({{2, 2}, {1, 1}}), "apart");
    EXPECT_EQ(state_of({{1, 1}, {1, 1}}), "messy"); // neither ascending nor apart
    EXPECT_EQ(state_of({{INFINITY, INFINITY}, {INFINITY, INFINITY}}), "messy");
}

TEST(Order, OfVolumes) {
    EXPECT_EQ(state_of({{1, 2}, {2, 3}}), "tidy");
    EXPECT_EQ(state_of({{2, 3}, {1, 2}}), "apart");
    EXPECT_EQ(state_of({{1, 2.5f}, {2, 3}}), "sorted");
    EXPECT_EQ(state_of({{1, 9}, {2, 3}, {4, 5}}), "sorted");
    EXPECT_EQ(state_of({{1, 2}, {1, 3}}), "sorted");
    EXPECT_EQ(state_of({{1, 3}, {1, 2}}), "messy");
    EXPECT_EQ(state_of({{1, 2}, {1, 2}}), "messy");
}

// Points may be at either end of a volume, but not inside.
TEST(Order, OfPointsAndVolumes) {
    EXPECT_EQ(state_of({{1, 1}, {1, 2}}), "tidy");
    EXPECT_EQ(state_of({{1, 2}, {1, 1}}), "apart");
    EXPECT_EQ(state_of({{1, 2}, {2, 2}}), "tidy");
    EXPECT_EQ(state_of({{1, 2}, {1.5f, 1.5f}}), "sorted");
    EXPECT_EQ(state_of({{1.5f, 1.5f}, {1, 2}}), "messy");
}

TEST(Order, OnePixelDecidesForAll) {
    const TestPixel tidy{{.z = 1}, {.z = 2}}, reversed{{.z = 2}, {.z = 1}};
    EXPECT_TRUE(order_of(ldi_of({tidy, tidy})).sorted);
    EXPECT_FALSE(order_of(ldi_of({tidy, reversed, tidy})).sorted);
    EXPECT_TRUE(order_of(ldi_of({tidy, reversed, tidy})).apart);
}

TEST(Order, WhatIsNoNumberHasNone) {
    EXPECT_EQ(state_of({{NAN, NAN}, {1, 1}}), "messy");
    EXPECT_EQ(state_of({{1, 1}, {NAN, NAN}, {2, 2}}), "messy");
}

} // namespace
} // namespace sparselens
