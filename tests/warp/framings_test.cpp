// Warping views with shifted frusta, other focal lengths, or cameras in front of or behind the lens.
#include "deep/checks/pose_check.h"
#include "deep/view_samples.h"
#include "support/ldi_samples.h"
#include "support/views.h"
#include "warp/reprojected_views.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace sparselens {
namespace {

constexpr double focal_px = 100, radius = 0.06;
constexpr int width = 64, height = 40;
const std::array positions{Imath::V2d(radius, 0), Imath::V2d(0, radius), Imath::V2d(-radius, 0),
                           Imath::V2d(0, -radius)};

Windows grown(Imath::Box2i data, const Imath::V2i &by) {
    Windows w = windows_of_size(width, height);
    w.data = {data.min + by, data.max + by};
    return w;
}
const Windows picture = windows_of_size(width, height);

Ldi warped(const std::vector<View> &views, Merge merge) {
    Progress silent;
    return warp(views, {.focal_px = focal_px, .radius = radius, .merge = merge, .extend_surfaces = false},
                silent);
}

// Stripes before a wall. Colours are linear in position, so that the mean of samples shows the colour at their mean
// position.
float stripes(double x, double y) { return float(0.2 + 0.005 * x + 0.003 * y); }
float wall(double x, double y) { return float(0.3 + 0.004 * x - 0.002 * y); }
TwoPlanes scene() {
    TwoPlanes planes{.focal_px = focal_px};
    planes.front_covers = [](double x, double) { return std::fmod(x + 1000.25, 16) < 6; };
    planes.front_red = stripes;
    planes.back_green = wall;
    return planes;
}

std::vector<View> views_of(const std::array<Framing, 4> &framings) {
    std::vector<View> views{scene().view(picture, {0, 0})};
    for (std::size_t k = 0; k < positions.size(); ++k)
        views.push_back(scene().view(picture, positions[k], framings[k]));
    return views;
}

const std::array<Framing, 4> no_framings{};
// The shifts of a lens that converge at z = 5, which move every pixel by F X / 5.
const std::array<Framing, 4> converging{{{.principal_point = {-0.01875, 0}},
                                         {.principal_point = {0, 0.01875}},
                                         {.principal_point = {0.01875, 0}},
                                         {.principal_point = {0, -0.01875}}}};
const std::array<Framing, 4> any_framings{{{0.02, 1.03, {0.013, -0.021}},
                                           {-0.03, 0.98, {0, 0.04}},
                                           {0, 1.05, {-0.05, 0}},
                                           {0.01, 1, {0.03, 0.02}}}};

// A plane seen through any frustum lands at the positions of its points.
TEST(Framings, APlaneLandsWhereItIs) {
    for (const auto &framings : {no_framings, converging, any_framings})
        for (std::size_t k = 0; k < positions.size(); ++k) {
            const double z = 3;
            const Framing &framing = framings[k];
            const View view =
                make_view(picture, positions[k], [&](int, int) { return ViewPixel{.z = float(z)}; });
            const ViewSamples of_view(view, view.image.channels);
            std::vector<ReprojectedSample> samples;
            Reprojection(of_view, {positions[k], focal_px, picture, framing})
                .append_rows(-1000, 1000, samples);
            ASSERT_EQ(samples.size(), picture.pixels());
            for (const ReprojectedSample &s : samples) {
                const Imath::V2d q(s.source % width + 0.5, s.source / width + 0.5);
                // The ray of q from the view's camera to the plane; then the point's position in the centre's picture.
                const double focal = focal_px * framing.zoom, depth = z - framing.forward;
                const double x =
                    positions[k].x + (q.x - width * (0.5 + framing.principal_point.x)) / focal * depth;
                const double y =
                    positions[k].y - (q.y - height * 0.5 - width * framing.principal_point.y) / focal * depth;
                EXPECT_NEAR(s.x + 0.5 + double(s.dx), width * 0.5 + focal_px * x / z, 1e-6);
                EXPECT_NEAR(s.y + 0.5 + double(s.dy), height * 0.5 - focal_px * y / z, 1e-6);
            }
        }
}

TEST(Framings, SamplesFallWithinTheReachAndInOneBand) {
    const Windows w = grown({{-5, -3}, {60, 42}}, {0, 0});
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const View view = random_view(w, positions[k], 4);
        const ViewSamples of_view(view, view.image.channels);
        const Reprojection reprojection(of_view, {positions[k], focal_px, w, any_framings[k], {0.01, 0.02}});
        std::vector<ReprojectedSample> all, band;
        reprojection.append_rows(-10'000, 10'000, all);
        EXPECT_EQ(all.size(), of_view.as_ldi().samples());
        for (const ReprojectedSample &s : all)
            EXPECT_TRUE(reprojection.reach().intersects(Imath::V2i(s.x, s.y)));
        for (int row = -100; row < 200; row += 7) reprojection.append_rows(row, row + 6, band);
        EXPECT_EQ(band.size(), all.size());
    }
}

// Frusta shifted by whole pixels, of the same rays, give the same LDI.
TEST(Framings, TheSameRaysGiveTheSameLdi) {
    const std::array shifts{Imath::V2i(3, 0), Imath::V2i(-2, 5), Imath::V2i(0, -4), Imath::V2i(-7, -1)};
    std::vector<View> straight{scene().view(picture, {0, 0})}, shifted = straight;
    for (std::size_t k = 0; k < positions.size(); ++k) {
        straight.push_back(scene().view(picture, positions[k]));
        const Framing framing{.principal_point = Imath::V2d(shifts[k]) / width};
        shifted.push_back(scene().view(grown(picture.data, shifts[k]), positions[k], framing));
        EXPECT_EQ(shifted.back().image.values.size(), straight.back().image.values.size());
    }
    for (const Merge merge : {Merge::average, Merge::keep}) {
        const Ldi a = warped(straight, merge), b = warped(shifted, merge);
        EXPECT_GT(a.samples(), picture.pixels());
        EXPECT_EQ(a.windows, b.windows);
        ASSERT_EQ(a.begin, b.begin);
        for (std::size_t i = 0; i < a.samples(); ++i) {
            EXPECT_NEAR(a.z[i], b.z[i], 1e-6);
            EXPECT_NEAR(a.dx[i], b.dx[i], 1e-5);
            EXPECT_NEAR(a.dy[i], b.dy[i], 1e-5);
            EXPECT_EQ(a.weight[i], b.weight[i]);
            for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(a.values[c][i], b.values[c][i], 1e-5);
        }
    }
}

// visit(position, z, coverage, red, green) for the samples in the centre view's picture, away from its borders.
template <typename Visit>
void for_each_sample(const Ldi &ldi, const Visit &visit) {
    const Imath::Box2i &data = ldi.windows.data;
    std::size_t pixel = 0;
    for (int y = data.min.y; y <= data.max.y; ++y)
        for (int x = data.min.x; x <= data.max.x; ++x, ++pixel) {
            if (x < 8 || x >= width - 8 || y < 8 || y >= height - 8) continue;
            for (const std::uint64_t i : ldi.pixel(pixel))
                visit(Imath::V2d(x + 0.5 + double(ldi.dx[i]), y + 0.5 + double(ldi.dy[i])), ldi.z[i],
                      ldi.values[3][i], ldi.values[0][i], ldi.values[1][i]);
        }
}

// Every sample shows the colour at its position, and the LDI has as much of the hidden wall as the views see.
TEST(Framings, EverySampleShowsWhatLiesThere) {
    const auto hidden_wall = [&](const std::array<Framing, 4> &framings) {
        double hidden = 0;
        for_each_sample(warped(views_of(framings), Merge::average),
                        [&](const Imath::V2d &p, float z, float coverage, float red, float green) {
                            const bool front = z < 5;
                            EXPECT_NEAR(z, front ? 2 : 10, 1e-4);
                            EXPECT_NEAR(red / coverage, front ? stripes(p.x, p.y) : 0, 1e-4);
                            EXPECT_NEAR(green / coverage, front ? 0 : wall(p.x, p.y), 1e-4);
                            const bool behind_stripe = std::fmod(std::floor(p.x) + 0.5 + 1000.25, 16) < 6;
                            if (!front && behind_stripe) hidden += double(coverage);
                        });
        return hidden;
    };
    // 3 stripes of 24 rows; the views look behind them from both sides by F R (1/2 - 1/10) pixels, to about the nearest
    // half pixel.
    const double truth = 3 * 24 * 2 * focal_px * radius * 0.4;
    for (const auto &framings : {no_framings, converging, any_framings})
        EXPECT_NEAR(hidden_wall(framings), truth, 0.2 * truth);
}

// The centre view sees nothing behind its camera.
TEST(Framings, WhatLiesBehindTheCentreIsLeftOut) {
    std::vector<View> views = views_of(no_framings);
    const std::size_t before = warped({views[0]}, Merge::average).samples();
    View behind = views[1];
    behind.framing.forward = -1;
    std::fill(behind.z.begin(), behind.z.end(), -0.25f); // 0.75 in front of itself
    EXPECT_EQ(warped({views[0], behind}, Merge::average).samples(), before);
    EXPECT_FALSE(better_position(views[0], behind, focal_px));
}

// A view's position is checked with its framing.
TEST(Framings, AViewInItsPlaceIsNotComplainedOf) {
    for (const auto &framings : {converging, any_framings}) {
        const std::vector<View> views = views_of(framings);
        for (std::size_t k = 1; k < views.size(); ++k) {
            EXPECT_FALSE(better_position(views[0], views[k], focal_px)) << k;
            View wrong = views[k];
            wrong.position = -wrong.position;
            if (wrong.position.x == 0) continue; // stripes hardly distinguish up from down
            const auto better = better_position(views[0], wrong, focal_px);
            ASSERT_TRUE(better) << k;
            EXPECT_LT((*better - views[k].position).length(), 1e-9) << k;
        }
    }
}

} // namespace
} // namespace sparselens
