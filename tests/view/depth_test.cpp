#include "view/depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double focal_px = 100;

TEST(PlanarDepth, PlanarStaysAsItIs) {
    const Windows w = windows_of_size(200, 100);
    for (const double z : {1e-30, 5.0, 1e30, inf})
        EXPECT_EQ(planar_depth(DepthMeaning::planar, z, 3, 4, w, focal_px), z);
}

TEST(PlanarDepth, InverseZeroIsInfinity) {
    const Windows w = windows_of_size(200, 100);
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::inverse, 0.25, 0, 0, w, focal_px), 4);
    EXPECT_EQ(planar_depth(DepthMeaning::inverse, 0, 0, 0, w, focal_px), inf);
    EXPECT_EQ(planar_depth(DepthMeaning::inverse, -0.0, 0, 0, w, focal_px), inf);
}

TEST(PlanarDepth, OnTheAxisARayIsAsLongAsItsDepth) {
    const Windows w = windows_of_size(201, 101); // a pixel centre is on the axis
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::distance, 7, 100, 50, w, focal_px), 7);
    EXPECT_EQ(planar_depth(DepthMeaning::distance, inf, 0, 0, w, focal_px), inf);
}

// The ray through a pixel 75 to the right and 0 (or 30 and 60) off the axis: sides 3, 4, 5 and 1, 2, ...
TEST(PlanarDepth, RayLengthByPythagoras) {
    const Windows w = windows_of_size(201, 201);
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::distance, 5, 175, 100, w, focal_px), 4);
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::distance, 5, 25, 100, w, focal_px), 4);
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::distance, 5, 100, 175, w, focal_px), 4);
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::distance, 3, 200, 200, w, focal_px), 3 / std::sqrt(3.0));
}

TEST(PlanarDepth, TheAxisGoesThroughTheDisplayWindowNotTheData) {
    const Windows crop{Imath::Box2i({-100, 10}, {100, 210}), Imath::Box2i({60, 100}, {90, 120})};
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::distance, 5, 75, 110, crop, focal_px), 4);
}

// Pixels twice as wide as high: 150 rows are as far from the axis as 75 columns.
TEST(PlanarDepth, PixelAspectStretchesRows) {
    Windows w = windows_of_size(201, 401);
    w.pixel_aspect = 2;
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::distance, 5, 100, 350, w, focal_px), 4);
    EXPECT_DOUBLE_EQ(planar_depth(DepthMeaning::distance, 5, 175, 200, w, focal_px), 4);
}

// A lens shifted by an eighth and a quarter of the picture's width: the axis meets the picture 25 to the right and 50
// below.
TEST(PlanarDepth, TheAxisGoesThroughThePrincipalPoint) {
    const Windows w{Imath::Box2i({0, 0}, {199, 199}), Imath::Box2i({0, 0}, {199, 199})};
    const Imath::V2d shifted(0.1275, 0.2525); // to the centres of pixels
    const auto z = [&](int x, int y) {
        return planar_depth(DepthMeaning::distance, 5, x, y, w, focal_px, shifted);
    };
    EXPECT_DOUBLE_EQ(z(125, 150), 5);
    EXPECT_DOUBLE_EQ(z(50, 150), 4);
    EXPECT_DOUBLE_EQ(z(125, 75), 4);
    EXPECT_DOUBLE_EQ(z(200, 150), 4);
    for (const DepthMeaning meaning : {DepthMeaning::planar, DepthMeaning::inverse})
        EXPECT_EQ(planar_depth(meaning, 5, 3, 4, w, focal_px, shifted),
                  planar_depth(meaning, 5, 3, 4, w, focal_px));
}

TEST(Depth, SkyIsWhatRenderersWriteForIt) {
    for (const DepthMeaning meaning : {DepthMeaning::planar, DepthMeaning::distance}) {
        for (const double sky : {1e10, 1e30, 65504.0, double(INFINITY)})
            EXPECT_TRUE(is_sky(meaning, sky, 1e10)) << sky;
        for (const double thing : {1e9, 65505.0, 65503.0, 0.1, -1.0, double(NAN)})
            EXPECT_FALSE(is_sky(meaning, thing, 1e10)) << thing;
        EXPECT_TRUE(is_sky(meaning, 1000, 1000)); // the far clip
        EXPECT_FALSE(is_sky(meaning, 999, 1000));
    }
    for (const double near : {0.0, 1000.0, 65504.0, 1e10})
        EXPECT_FALSE(is_sky(DepthMeaning::disparity, near, 1000));
    EXPECT_TRUE(is_sky(DepthMeaning::inverse, 0, 1e10));
    EXPECT_TRUE(is_sky(DepthMeaning::inverse, 1e-3, 1000));
    EXPECT_FALSE(is_sky(DepthMeaning::inverse, 2e-3, 1000));
    EXPECT_FALSE(is_sky(DepthMeaning::inverse, 65504, 1e10)); // very near
    EXPECT_FALSE(is_sky(DepthMeaning::inverse, -1, 1e10));
}

TEST(PlanarDepth, NegativeIsTheZOfACameraThatLooksAlongMinusZ) {
    const Windows w = windows_of_size(200, 100);
    EXPECT_EQ(planar_depth(DepthMeaning::negative, -7, 3, 4, w, focal_px), 7);
    EXPECT_EQ(planar_depth(DepthMeaning::negative, -inf, 3, 4, w, focal_px), inf);
    for (const double sky : {-1e10, -65504.0, -inf, 1e30})
        EXPECT_TRUE(is_sky(DepthMeaning::negative, sky, 1e10)) << sky;
    for (const double thing : {-1e9, -1.0, 0.0})
        EXPECT_FALSE(is_sky(DepthMeaning::negative, thing, 1e10)) << thing;
}

TEST(NormalizedDepth, IsLinearBetweenThePlanes) {
    const DepthRange range{2, 10};
    EXPECT_EQ(normalized_depth(0, range), 2);
    EXPECT_EQ(normalized_depth(0.25, range), 4);
    EXPECT_EQ(normalized_depth(1, range), 10);
    EXPECT_TRUE(is_sky(DepthMeaning::normalized, 1, range.far));
    EXPECT_FALSE(is_sky(DepthMeaning::normalized, 0.999, range.far));
}

TEST(HyperbolicDepth, IsLinearInInverseDepthBetweenThePlanes) {
    const DepthRange range{2, 10};
    for (const double z : {2.0, 2.5, 4.0, 8.0, 10.0})
        EXPECT_NEAR(hyperbolic_depth((1 / range.near - 1 / z) / (1 / range.near - 1 / range.far), range), z,
                    1e-12);
    EXPECT_EQ(hyperbolic_depth(0.75, {2, inf}), 8);
    EXPECT_TRUE(is_sky(DepthMeaning::hyperbolic, 1, range.far));
    EXPECT_FALSE(is_sky(DepthMeaning::hyperbolic, 0.999, range.far));
}

TEST(NormalizedDepth, WithoutAFarPlaneIsThatOfADepthBuffer) {
    const DepthRange range{2, inf};
    EXPECT_EQ(normalized_depth(0, range), 2);
    EXPECT_EQ(normalized_depth(0.75, range), 8);
    EXPECT_EQ(normalized_depth(1, range), inf);
}

} // namespace
} // namespace sparselens
