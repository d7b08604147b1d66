// How rays are divided between views and renders through the lens.
#include "base/error.h"
#include "plan/plan.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(DivideRays, FewRaysGoIntoViews) {
    const RayDivision five = divide_rays(5, 5, 2, 1e-3);
    EXPECT_EQ(five.supersample, 1);
    EXPECT_EQ(five.samples, 1);
    EXPECT_EQ(five.per_render, 0);
    const RayDivision twenty = divide_rays(20, 5, 2, 1e-3);
    EXPECT_EQ(twenty.supersample, 2);
    EXPECT_EQ(twenty.samples, 1);
    EXPECT_EQ(twenty.per_render, 0);
}

TEST(DivideRays, FurtherRaysGoThroughTheLens) {
    const RayDivision division = divide_rays(320, 5, 2, 1e-3);
    EXPECT_EQ(division.of_views(), 40);
    EXPECT_EQ(division.samples, 2);
    EXPECT_EQ(division.per_render, 140);
    EXPECT_EQ(divide_rays(1280, 5, 2, 1e-3).of_views(), 40);
}

TEST(DivideRays, NoRayIsSpentTwice) {
    for (int supersample = 1; supersample <= 3; ++supersample)
        for (int views = 1; views <= 9; ++views)
            for (int rays = views, before = 0; rays < 300; ++rays) {
                const RayDivision division = divide_rays(rays, views, supersample, 1e-3);
                const int used = division.of_views() + 2 * division.per_render;
                EXPECT_LE(used, rays);
                EXPECT_GE(division.of_views(), before)
                    << rays << " rays: fewer for views than with one ray less";
                before = division.of_views();
                if (division.per_render > 0) {
                    EXPECT_GE(used, rays - 1);
                }
            }
}

TEST(DivideRays, OneRenderOfLittleNoiseNeedsNoViews) {
    EXPECT_FALSE(divide_rays(320, 5, 2, 1e-4).alone);
    EXPECT_TRUE(divide_rays(320, 5, 2, 1e-6).alone);
    EXPECT_TRUE(divide_rays(5, 5, 2, 0).alone);              // all is in focus, of one colour
    EXPECT_EQ(divide_rays(320, 5, 2, 1e-6).per_render, 140); // for pictures that can be refocused
}

TEST(DivideRays, RefusesFewerRaysThanViews) { EXPECT_THROW(divide_rays(4, 5, 1, 1e-3), UsageError); }

} // namespace
} // namespace sparselens
