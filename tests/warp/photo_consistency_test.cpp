#include "support/views.h"
#include "warp/photo_consistency.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparselens {
namespace {

constexpr double focal_px = 100, radius = 0.06, scale = focal_px * radius;
const Windows window = windows_of_size(64, 16);

using Colour = std::function<float(double x, double y)>;

// A wall at that depth on which each view sees its own colours.
std::vector<View> wall(const std::function<Colour(const Imath::V2d &camera)> &colour_for, float noise = 0,
                       double z = 2.2) {
    std::vector<View> views;
    for (const Imath::V2d &camera :
         {Imath::V2d(0, 0), Imath::V2d(radius, 0), Imath::V2d(0, radius), Imath::V2d(-radius, 0)}) {
        TwoPlanes scene;
        scene.front_z = z;
        scene.front_covers = [](double, double) { return true; };
        scene.front_red = colour_for(camera);
        scene.noise = noise;
        views.push_back(scene.view(window, camera));
    }
    return views;
}

PhotoConsistency consistency(const std::vector<View> &views, std::optional<double> focus = {}) {
    const ReprojectedViews placed(views, focal_px, scale, 0);
    ReprojectedRows rows = placed.place(window.data, 0, 15);
    PhotoConsistencyOptions options{.scale = scale};
    if (focus) options.lens = ThinLens{.radius = radius, .focal_px = focal_px, .focus = *focus};
    return find_photo_consistency(placed, options, window.data, find_surfaces(placed, 0.5 / scale, rows));
}

double share_that_differs(const std::vector<View> &views) {
    const std::vector<Disagreement> pixels = consistency(views).differ;
    return double(std::ranges::count(pixels, Disagreement::clear)) / double(pixels.size());
}

// The share of pixels where the views may be averaged.
double agreement(const std::vector<View> &views, std::optional<double> focus = {}) {
    const std::vector<bool> pixels = consistency(views, focus).averages;
    return double(std::ranges::count(pixels, true)) / double(pixels.size());
}

float stripes(double x) { return float(0.5 + 0.4 * std::sin(0.5 * x)); }

TEST(PhotoConsistency, OneTextureSeenByAll) {
    EXPECT_EQ(agreement(wall([](auto) { return [](double x, double) { return stripes(x); }; })), 1);
    EXPECT_EQ(agreement(wall(
                  [](auto) { return [](double x, double) { return std::fmod(x, 10) < 5 ? 1.0f : 0.0f; }; })),
              1);
}

// An edge between two pixels stays in place, although each view is shifted by part of a pixel and it may seem to move
// slightly.
TEST(PhotoConsistency, SharpEdgesOfTextureDoNotMove) {
    const auto edges = [](auto) {
        return [](double x, double) { return std::fmod(x + 100, 8) < 4 ? 0.7f : 0.2f; };
    };
    for (const double shift : {2.25, 2.35, 2.45, 2.6})
        EXPECT_EQ(share_that_differs(wall(edges, 0, scale / shift)), 0) << shift;
}

TEST(PhotoConsistency, ImagesThatMoveByAPixelDiffer) {
    const auto image = [](const Imath::V2d &camera) { // one pixel of disparity off
        return [camera](double x, double) {
            return float(0.5 + 0.4 * std::sin(0.2 * x + 0.2 * camera.x / radius));
        };
    };
    EXPECT_GT(share_that_differs(wall(image)), 0.8);
}

TEST(PhotoConsistency, ImagesThatMoveByTwoFifthsOfAPixelDifferSlightly) {
    const auto image = [](const Imath::V2d &camera) {
        return [camera](double x, double) {
            return float(0.5 + 0.4 * std::sin(0.2 * x + 0.08 * camera.x / radius));
        };
    };
    const std::vector<Disagreement> differ = consistency(wall(image)).differ;
    EXPECT_GT(std::ranges::count(differ, Disagreement::slight), 0.8 * double(differ.size()));
}

TEST(PhotoConsistency, NoiseIsNoDisagreement) {
    const auto grey = [](auto) { return [](double, double) { return 0.5f; }; };
    for (const float noise : {0.01f, 0.1f, 0.5f}) EXPECT_EQ(agreement(wall(grey, noise)), 1) << noise;
}

// Another colour, or the same picture at another position.
TEST(PhotoConsistency, ReflectionsAreDisagreement) {
    const auto other_colour = [](const Imath::V2d &camera) {
        return [camera](double, double) { return camera.x == 0 && camera.y == 0 ? 0.2f : 0.8f; };
    };
    EXPECT_EQ(agreement(wall(other_colour)), 0);
    EXPECT_LT(agreement(wall(other_colour, 0.1f)), 0.1);
    const auto reflection = [](const Imath::V2d &camera) {
        return [camera](double x, double) { return stripes(x + 60 * camera.x + 40 * camera.y); };
    };
    EXPECT_EQ(agreement(wall(reflection)), 0);
}

// The lens itself averages the light of one point over all directions.
TEST(PhotoConsistency, InFocusAllDirectionsCount) {
    const auto views = wall([](const Imath::V2d &camera) {
        return [camera](double, double) { return float(0.5 + 4 * camera.x); };
    });
    EXPECT_EQ(agreement(views, 2.2), 1);
    EXPECT_EQ(agreement(views, 2.5), 1); // |CoC| 0.33
    EXPECT_EQ(agreement(views, 50), 0);
}

TEST(PhotoConsistency, WhatDisagreesIsNotAveraged) {
    const auto views = wall([](const Imath::V2d &camera) {
        return [camera](double, double) { return camera.x == 0 && camera.y == 0 ? 0.25f : 0.75f; };
    });
    Progress silent;
    WarpOptions options{.focal_px = focal_px, .radius = radius};
    const auto red_at = [&](int x, int y) {
        const Ldi ldi = warp(views, options, silent);
        const Imath::V2i first = ldi.windows.data.min;
        const auto pixel =
            std::size_t(y - first.y) * std::size_t(ldi.windows.width()) + std::size_t(x - first.x);
        return ldi.values[0][ldi.pixel(pixel).front()];
    };
    EXPECT_EQ(red_at(30, 8), 0.25f);
    options.test_photo_consistency = false;
    EXPECT_GT(red_at(30, 8), 0.3f);
    options.test_photo_consistency = true;
    options.focus = 2.2;
    EXPECT_GT(red_at(30, 8), 0.3f);
}

} // namespace
} // namespace sparselens
