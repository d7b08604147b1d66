#include "deep/view_samples.h"
#include "lens/thin_lens.h"
#include "support/views.h"
#include "warp/reprojected_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

// A picture of 21 x 21 pixels, F = 100, empty except pixel (10, 10) at depth z.
std::vector<ReprojectedSample> reprojected(float z, const Imath::V2d &position, float pixel_aspect = 1) {
    Windows w = windows_of_size(21, 21);
    w.pixel_aspect = pixel_aspect;
    const View view = make_view(
        w, position, [&](int x, int y) { return ViewPixel{.z = z, .a = x == 10 && y == 10 ? 1.0f : 0.0f}; });
    std::vector<ReprojectedSample> samples;
    const ViewSamples of_view(view, view.image.channels);
    Reprojection(of_view, {position, 100, w}).append_rows(-1000, 1000, samples);
    return samples;
}

void expect_at(const std::vector<ReprojectedSample> &samples, double x, double y) {
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_NEAR(samples[0].x + 0.5 + double(samples[0].dx), x, 1e-6);
    EXPECT_NEAR(samples[0].y + 0.5 + double(samples[0].dy), y, 1e-6);
    EXPECT_LE(std::abs(samples[0].dx), 0.5f);
    EXPECT_LE(std::abs(samples[0].dy), 0.5f);
    EXPECT_EQ(samples[0].source, 10u * 21 + 10);
}

// A point straight ahead of a camera on the right is on the right for the centre. Up is up, while y counts down.
TEST(Reprojection, PointsLieWhereTheCameraStands) {
    expect_at(reprojected(4, {0.13, 0}), 10.5 + 3.25, 10.5);
    expect_at(reprojected(4, {-0.13, 0}), 10.5 - 3.25, 10.5);
    expect_at(reprojected(4, {0, 0.13}), 10.5, 10.5 - 3.25);
    expect_at(reprojected(4, {0, -0.13}), 10.5, 10.5 + 3.25);
    expect_at(reprojected(2, {0.13, -0.13}), 10.5 + 6.5, 10.5 + 6.5);
}

TEST(Reprojection, IsTheThinLensSeenFromTheCentre) {
    const ThinLens lens{.radius = 0.25, .focal_px = 100, .focus = 5, .pixel_aspect = 2};
    const Imath::V2d u(0.6, -0.8);
    const Imath::V2d p = seen_from_centre(lens, {10.5, 10.5}, 3, u);
    expect_at(reprojected(3, 0.25 * u, 2), p.x, p.y);
}

TEST(Reprojection, WidePixelsMoveTwiceAsManyRows) {
    expect_at(reprojected(4, {0, 0.13}, 2), 10.5, 10.5 - 6.5);
    expect_at(reprojected(4, {0.13, 0}, 2), 10.5 + 3.25, 10.5);
}

TEST(Reprojection, WhatIsInfinitelyFarStays) {
    for (const Imath::V2d &position : {Imath::V2d(0, 0), Imath::V2d(1e6, -1e6)}) {
        expect_at(reprojected(inf, position), 10.5, 10.5);
        EXPECT_EQ(reprojected(inf, position)[0].inverse_z, 0);
    }
}

TEST(Reprojection, TheNearestMayLeaveThePicture) {
    EXPECT_TRUE(reprojected(1e-3f, {0, 1}).empty());          // outside the requested rows
    EXPECT_TRUE(reprojected(1e-30f, {1e10, 0}).empty());      // beyond any coordinate
    EXPECT_EQ(reprojected(1e-3f, {1, 0})[0].x, 10 + 100'000); // the caller cuts it
}

TEST(Reprojection, ReachIsWhereSamplesFall) {
    const auto reach = [](const Imath::V2d &position, float z, float empty_z = 0) {
        const View view = make_view(windows_of_size(21, 11), position, [&](int x, int) {
            return x < 3 ? ViewPixel{.z = empty_z, .a = 0} : ViewPixel{.z = z};
        });
        return Reprojection(ViewSamples(view, view.image.channels), {position, 100, view.image.windows})
            .reach();
    };
    EXPECT_EQ(reach({0, 0}, 4), Imath::Box2i({0, 0}, {20, 10}));
    EXPECT_EQ(reach({1e6, 1e6}, inf), Imath::Box2i({0, 0}, {20, 10}));
    EXPECT_EQ(reach({0.13, 0}, 4), Imath::Box2i({0, 0}, {23, 10})); // 3.25 px to the right
    EXPECT_EQ(reach({-0.15, 0}, 4), Imath::Box2i({-4, 0}, {20, 10}));
    EXPECT_EQ(reach({0, 0.15}, 4), Imath::Box2i({0, -4}, {20, 10}));
    // Invisible pixels do not count, whatever their depth.
    for (const float empty_z : {0.0f, 1e-6f, -1.0f, std::nanf("")})
        EXPECT_EQ(reach({0.13, 0.13}, 4, empty_z), reach({0.13, 0.13}, 4)) << empty_z;
}

TEST(Reprojection, NoSampleFallsOutsideTheReach) {
    const Windows w{Imath::Box2i({0, 0}, {63, 47}), Imath::Box2i({-5, -3}, {60, 50})};
    for (const Imath::V2d &position : {Imath::V2d(0.03, 0.05), Imath::V2d(-0.02, -0.07)}) {
        const View view = random_view(w, position, 4);
        const ViewSamples of_view(view, view.image.channels);
        const Reprojection reprojection(of_view, {position, 100, w});
        std::vector<ReprojectedSample> all;
        reprojection.append_rows(-10'000, 10'000, all);
        for (const ReprojectedSample &s : all)
            EXPECT_TRUE(reprojection.reach().intersects(Imath::V2i(s.x, s.y)));
    }
}

// Every sample falls into exactly one band of rows, in the order of the source.
TEST(Reprojection, BandsShareTheSamples) {
    const Windows w{Imath::Box2i({0, 0}, {63, 47}), Imath::Box2i({-5, -3}, {60, 50})};
    for (const Imath::V2d &position : {Imath::V2d(0.03, 0.05), Imath::V2d(-0.02, -0.07), Imath::V2d(0, 0)}) {
        const View view = random_view(w, position, 4);
        const ViewSamples of_view(view, view.image.channels);
        const Reprojection reprojection(of_view, {position, 100, w});
        std::vector<ReprojectedSample> all, band;
        reprojection.append_rows(-10'000, 10'000, all);
        std::size_t shared = 0;
        for (int row = -60; row < 120; row += 7) {
            band.clear();
            reprojection.append_rows(row, row + 6, band);
            for (std::size_t i = 0; i < band.size(); ++i) {
                EXPECT_TRUE(band[i].y >= row && band[i].y <= row + 6);
                EXPECT_TRUE(i == 0 || band[i - 1].source < band[i].source);
            }
            shared += band.size();
        }
        std::size_t visible = 0;
        for (const float alpha : view.image.plane(3)) visible += alpha != 0;
        EXPECT_EQ(all.size(), visible);
        EXPECT_EQ(shared, visible);
    }
}

TEST(Reprojection, WithoutAlphaEverythingIsVisible) {
    View view = random_view(windows_of_size(8, 8), {0, 0}, 1);
    view.image = Image(view.image.windows, {{"Y"}});
    std::vector<ReprojectedSample> samples;
    const ViewSamples of_view(view, view.image.channels);
    Reprojection(of_view, {view.position, 100, of_view.windows}).append_rows(0, 7, samples);
    EXPECT_EQ(samples.size(), 64u);
}

} // namespace
} // namespace sparselens
