#include "deep/mixed_pixels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

using Imath::V3d;

const V3d red{1, 0.1, 0}, green{0, 0.8, 0.2};

V3d mixed(double share, const V3d &f, const V3d &b) { return share * f + (1 - share) * b; }

TEST(Unmix, FindsTheShareOfTheFirst) {
    for (const double share : {0.05, 0.25, 0.45, 0.55, 0.75, 0.95}) {
        const auto mix = unmix(mixed(share, red, green), red, green, share < 0.5 ? mostly_b : mostly_f, 0.1);
        ASSERT_TRUE(mix) << share;
        EXPECT_NEAR(mix->share, share, 0.005); // "not mixed" counts a little
        EXPECT_LT(mix->residual, 0.005);
    }
}

TEST(Unmix, TheShareIsOnTheSideOfThePixelsDepth) {
    const V3d bright{1, 1, 0.5}, dark{0, 0.2, 0.1};
    EXPECT_DOUBLE_EQ(unmix(mixed(0.55, bright, dark), bright, dark, mostly_b, 0.2)->share, 0.5);
    EXPECT_DOUBLE_EQ(unmix(mixed(0.45, bright, dark), bright, dark, mostly_f, 0.2)->share, 0.5);
    EXPECT_FALSE(unmix(mixed(0.9, bright, dark), bright, dark, mostly_b, 0.2));
}

TEST(Unmix, SaysHowFarTheColourIsFromTheLine) {
    V3d c = mixed(0.4, red, green);
    const V3d contrast = red - green;
    const double size = std::sqrt(contrast.dot(contrast));
    // At a right angle to the line, because it has little blue.
    const double along = contrast[2] / size;
    c += 0.15 * (V3d(0, 0, size) - along * contrast) / std::sqrt(1 - along * along);
    const auto mix = unmix(c, red, green, mostly_b, 0.2);
    ASSERT_TRUE(mix);
    EXPECT_NEAR(mix->residual, 0.15, 0.01);
    EXPECT_FALSE(unmix(c, red, green, mostly_b, 0.1));
}

TEST(Unmix, LeavesLightInFront) {
    const V3d dark{0, 0, 0}, bright{1, 1, 1};
    for (const double level : {0.05, 0.3, 0.49, 0.55}) {
        const V3d c{level, level * 0.95, level * 1.05};
        const auto mix = unmix(c, dark, bright, level > 0.5 ? mostly_b : mostly_f, 0.2);
        ASSERT_TRUE(mix) << level;
        for (int k = 0; k < 3; ++k) EXPECT_LE((1 - mix->share) * bright[k], c[k] * (1 + 1e-12));
    }
}

// A pixel of the sky, with a background colour from a pixel of which a lamp covers a twentieth. What is left without so
// bright a background would be dark.
TEST(Unmix, TheRestIsNotMoreThanTheDepthAllows) {
    const V3d lamp{8, 10, 15}, sky{0.5, 0.45, 0.55}, brighter = mixed(0.05, lamp, sky);
    EXPECT_FALSE(unmix(sky, lamp, brighter, mostly_b, 0.1));
    EXPECT_TRUE(unmix(sky, lamp, brighter, no_prior, 0.1));
    EXPECT_TRUE(unmix(brighter, lamp, sky, mostly_b, 0.1));
}

TEST(Unmix, SaysNothingWhereNothingCanBeTold) {
    EXPECT_FALSE(unmix(red, red, red, mostly_f, 0.2));
    EXPECT_FALSE(unmix(red, red, green, mostly_f, 0.2));   // not mixed
    EXPECT_FALSE(unmix(green, red, green, mostly_b, 0.2)); // not mixed either
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        const V3d wrong{0.5, bad, 0}, half = mixed(0.5, red, green);
        EXPECT_FALSE(unmix(wrong, red, green, mostly_b, 0.2));
        EXPECT_FALSE(unmix(half, wrong, green, mostly_b, 0.2));
        EXPECT_FALSE(unmix(half, red, wrong, mostly_b, 0.2));
    }
}

const Imath::V4d opaque_red{1, 0.1, 0, 1}, veil{0, 0.4, 0.1, 0.5};

TEST(UnmixVeil, FindsTheShareAndTheDensity) {
    for (const double share : {0.05, 0.3, 0.5, 0.8})
        for (const double density : {0.2, 0.7, 1.0, 1.9}) {
            const auto mix =
                unmix_veil(share * opaque_red + (1 - share) * density * veil, opaque_red, veil, 0.1);
            ASSERT_TRUE(mix) << share << " " << density;
            EXPECT_NEAR(mix->share, share, 1e-12);
            EXPECT_NEAR(mix->density, density, 1e-12);
            EXPECT_NEAR(mix->residual, 0, 1e-7);
        }
}

TEST(UnmixVeil, CoverageTellsBlackFromNothing) {
    const Imath::V4d black{0, 0, 0, 1};
    const auto mix = unmix_veil(0.3 * black + 0.7 * veil, black, veil, 0.1);
    ASSERT_TRUE(mix);
    EXPECT_NEAR(mix->share, 0.3, 1e-12);
}

TEST(UnmixVeil, KeepsCoverageAndLight) {
    const Imath::V4d c{0.2, 0.3, 0.02, 0.6}; // not quite a mixture of the two
    const auto mix = unmix_veil(c, opaque_red, veil, 0.5);
    ASSERT_TRUE(mix);
    EXPECT_GT(mix->residual, 0.01);
    const double behind = (1 - mix->share) * mix->density;
    EXPECT_NEAR(mix->share + behind * veil[3], c[3], 1e-12);
    for (int k = 0; k < 3; ++k) EXPECT_LE(behind * veil[k], c[k] * (1 + 1e-12));
    EXPECT_FALSE(unmix_veil(c, opaque_red, veil, mix->residual * 0.99));
}

TEST(UnmixVeil, SaysNothingWhereNothingCanBeTold) {
    EXPECT_FALSE(unmix_veil(veil, 2.0 * veil, veil, 0.2));
    EXPECT_FALSE(unmix_veil(opaque_red, opaque_red, veil, 0.2)); // not mixed
    EXPECT_FALSE(unmix_veil(veil, opaque_red, veil, 0.2));
    EXPECT_FALSE(unmix_veil(veil, opaque_red, Imath::V4d(0, 0, 0, 0), 0.2));
    EXPECT_FALSE(
        unmix_veil(0.5 * opaque_red + Imath::V4d(0, 0, 0.8, 0), opaque_red, veil, 0.2)); // another colour
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_FALSE(unmix_veil(Imath::V4d(bad, 0, 0, 0.5), opaque_red, veil, 0.2));
}

} // namespace
} // namespace sparselens
