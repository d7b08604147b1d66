#include "warp/unmixing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr Rgb red{{1, 0.1, 0}}, green{{0, 0.8, 0.2}};

Rgb mixed(double share, const Rgb &f, const Rgb &b) {
    Rgb c;
    for (std::size_t k = 0; k < 3; ++k) c.v[k] = share * f.v[k] + (1 - share) * b.v[k];
    return c;
}

TEST(Unmix, FindsTheShareOfTheFirst) {
    for (const double share : {0.05, 0.25, 0.45, 0.55, 0.75, 0.95}) {
        const auto mix = unmix(mixed(share, red, green), red, green, share < 0.5, 0.1);
        ASSERT_TRUE(mix) << share;
        EXPECT_NEAR(mix->share, share, 0.005); // "not mixed" has a say
        EXPECT_LT(mix->residual, 0.005);
    }
}

TEST(Unmix, TheShareIsOnTheSideOfThePixelsDepth) {
    const Rgb bright{{1, 1, 0.5}}, dark{{0, 0.2, 0.1}};
    EXPECT_DOUBLE_EQ(unmix(mixed(0.55, bright, dark), bright, dark, true, 0.2)->share, 0.5);
    EXPECT_DOUBLE_EQ(unmix(mixed(0.45, bright, dark), bright, dark, false, 0.2)->share, 0.5);
    EXPECT_FALSE(unmix(mixed(0.9, bright, dark), bright, dark, true, 0.2));
}

TEST(Unmix, SaysHowFarTheColourIsFromTheLine) {
    Rgb c = mixed(0.4, red, green);
    const Rgb contrast = red.minus(green);
    const double size = std::sqrt(contrast.dot(contrast));
    // At a right angle to the line: it has little blue.
    const double along = contrast.v[2] / size;
    for (std::size_t k = 0; k < 3; ++k)
        c.v[k] += 0.15 * ((k == 2 ? size : 0) - along * contrast.v[k]) / std::sqrt(1 - along * along);
    const auto mix = unmix(c, red, green, true, 0.2);
    ASSERT_TRUE(mix);
    EXPECT_NEAR(mix->residual, 0.15, 0.01);
    EXPECT_FALSE(unmix(c, red, green, true, 0.1));
}

TEST(Unmix, LeavesLightInFront) {
    const Rgb dark{{0, 0, 0}}, bright{{1, 1, 1}};
    for (const double level : {0.05, 0.3, 0.49, 0.55}) {
        const Rgb c{{level, level * 0.95, level * 1.05}};
        const auto mix = unmix(c, dark, bright, level > 0.5, 0.2);
        ASSERT_TRUE(mix) << level;
        for (std::size_t k = 0; k < 3; ++k) EXPECT_LE((1 - mix->share) * bright.v[k], c.v[k] * (1 + 1e-12));
    }
}

TEST(Unmix, SaysNothingWhereNothingCanBeTold) {
    EXPECT_FALSE(unmix(red, red, red, false, 0.2));
    EXPECT_FALSE(unmix(red, red, green, false, 0.2));  // not mixed
    EXPECT_FALSE(unmix(green, red, green, true, 0.2)); // nor this
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        const Rgb wrong{{0.5, bad, 0}}, half = mixed(0.5, red, green);
        EXPECT_FALSE(unmix(wrong, red, green, true, 0.2));
        EXPECT_FALSE(unmix(half, wrong, green, true, 0.2));
        EXPECT_FALSE(unmix(half, red, wrong, true, 0.2));
    }
}

} // namespace
} // namespace sparselens
