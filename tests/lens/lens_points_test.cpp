#include "lens/lens_points.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(LensPoints, RimStartsOnTheRightAndTurnsUp) {
    const auto rim = rim_lens_points(4);
    const Imath::V2d expected[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    ASSERT_EQ(rim.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((rim[k] - expected[k]).length(), 1e-15) << k;
    EXPECT_TRUE(rim_lens_points(0).empty());
}

// A set of uniform density has the disc's moments: mean 0, mean of x^2 and of y^2 1/4, of r^4 1/3.
void expect_disc_moments(const std::vector<Imath::V2d> &points, double tolerance) {
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0, r4 = 0;
    for (const Imath::V2d &p : points) {
        EXPECT_LE(p.length(), 1 + 1e-12);
        x += p.x, y += p.y, xx += p.x * p.x, yy += p.y * p.y, xy += p.x * p.y,
            r4 += p.length2() * p.length2();
    }
    const double n = double(points.size());
    EXPECT_NEAR(x / n, 0, tolerance);
    EXPECT_NEAR(y / n, 0, tolerance);
    EXPECT_NEAR(xx / n, 0.25, tolerance);
    EXPECT_NEAR(yy / n, 0.25, tolerance);
    EXPECT_NEAR(xy / n, 0, tolerance);
    EXPECT_NEAR(r4 / n, 1.0 / 3, tolerance);
}

TEST(LensPoints, SpiralIsEvenInArea) {
    expect_disc_moments(spiral_lens_points(64), 1e-2);
    expect_disc_moments(spiral_lens_points(1024), 5e-4);
    EXPECT_EQ(spiral_lens_points(1).front(), Imath::V2d(0, 0));
}

TEST(LensPoints, DiscPointKeepsAreas) {
    std::vector<Imath::V2d> points;
    for (int j = 0; j < 128; ++j)
        for (int i = 0; i < 128; ++i) points.push_back(disc_point({(i + 0.5) / 128, (j + 0.5) / 128}));
    expect_disc_moments(points, 2e-4);
    EXPECT_EQ(disc_point({0.5, 0.5}), Imath::V2d(0, 0));
    EXPECT_EQ(disc_point({1, 0.5}), Imath::V2d(1, 0));
    EXPECT_EQ(disc_point({0.5, 0}), Imath::V2d(0, -1));
}

} // namespace
} // namespace sparselens
