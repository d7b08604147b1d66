#include "lens/thin_lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

TEST(ThinLens, CircleOfConfusionIsSignedAroundFocus) {
    EXPECT_DOUBLE_EQ(circle_of_confusion(lens, 5), 0);
    EXPECT_NEAR(circle_of_confusion(lens, 2.5), -7.68, 1e-12);
    EXPECT_NEAR(circle_of_confusion(lens, 10), 3.84, 1e-12);
}

TEST(ThinLens, InfinityIsALimitNotAnError) {
    EXPECT_DOUBLE_EQ(circle_of_confusion(lens, inf), 0.06 * 640 / 5);
    const ThinLens far{.radius = 0.06, .focal_px = 640, .focus = inf};
    EXPECT_DOUBLE_EQ(circle_of_confusion(far, 4), -9.6);
    EXPECT_DOUBLE_EQ(circle_of_confusion(far, inf), 0);
    EXPECT_DOUBLE_EQ(disparity(lens, inf), 0);
}

TEST(ThinLens, OneUlpFromFocusKeepsItsSignAndSize) {
    for (const double d : {1e-3, 5.0, 7.3e5}) {
        const ThinLens focused{.radius = 0.06, .focal_px = 640, .focus = d};
        const double beyond = std::nextafter(d, inf), before = std::nextafter(d, 0.0);
        const double slope = 0.06 * 640 / d / d;
        EXPECT_NEAR(circle_of_confusion(focused, beyond) / (slope * (beyond - d)), 1, 1e-12);
        EXPECT_NEAR(circle_of_confusion(focused, before) / (slope * (before - d)), 1, 1e-12);
    }
}

TEST(ThinLens, DisparityDifferenceIsRefocusable) {
    for (const double d : {0.5, 5.0, inf}) {
        const ThinLens focused{.radius = 0.06, .focal_px = 640, .focus = d};
        const double by_coc = circle_of_confusion(focused, 9) - circle_of_confusion(focused, 3);
        EXPECT_NEAR(by_coc, disparity(focused, 3) - disparity(focused, 9), 1e-11);
    }
}

TEST(ThinLens, PointBehindFocusMovesWithTheLensPoint) {
    const ThinLens anamorphic{.radius = 1, .focal_px = 1, .focus = 1, .pixel_aspect = 2};
    const Imath::V2d seen = seen_through(anamorphic, {10, 20}, 3, {0.5, 1});
    EXPECT_DOUBLE_EQ(seen.x, 11.5);
    EXPECT_DOUBLE_EQ(seen.y, 14);
}

// A view moved so that the plane of focus stays in place shows each point where the lens does.
TEST(ThinLens, AViewMovedOntoTheFocusPlaneIsTheViewThroughThatLensPoint) {
    const ThinLens anamorphic{.radius = 0.06, .focal_px = 640, .focus = 5, .pixel_aspect = 2};
    const Imath::V2d p(100, 50), u(0.6, -0.7);
    for (const double z : {0.7, 5.0, 40.0, inf}) {
        const Imath::V2d q = p - (seen_from_centre(anamorphic, p, z, u) - p); // its position in the view
        const Imath::V2d moved = seen_from_centre(anamorphic, q, anamorphic.focus, u);
        const Imath::V2d seen = seen_through(anamorphic, p, circle_of_confusion(anamorphic, z), u);
        EXPECT_NEAR(moved.x, seen.x, 1e-10);
        EXPECT_NEAR(moved.y, seen.y, 1e-10);
    }
    const Imath::V2d near = seen_from_centre(anamorphic, {0, 0}, 1, {1, 1});
    EXPECT_DOUBLE_EQ(near.x, 0.06 * 640);
    EXPECT_DOUBLE_EQ(near.y, -2 * 0.06 * 640);
}

} // namespace
} // namespace sparselens
