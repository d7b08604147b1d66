#include "support/views.h"
#include "warp/coverage.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sparselens {
namespace {

ViewSample sample_at(double dx, double dy, double weight) {
    ViewSample s{};
    s.dx = float(dx);
    s.dy = float(dy);
    s.weight = weight;
    return s;
}

// The expected squared error of a mean with weights that sum to 1: from noise and from the unknown gradient.
double error_of(const std::vector<ViewSample> &samples, const std::vector<double> &by) {
    double noise = 0, x = 0, y = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        noise += by[i] * by[i] / samples[i].weight;
        x += by[i] * double(samples[i].dx);
        y += by[i] * double(samples[i].dy);
    }
    return noise + kernels::gradient_to_noise * kernels::gradient_to_noise * (x * x + y * y);
}

std::vector<double> shares(const std::vector<ViewSample> &samples) {
    double sum = 0;
    for (const ViewSample &s : samples) sum += s.weight;
    std::vector<double> result;
    for (const ViewSample &s : samples) result.push_back(s.weight / sum);
    return result;
}

TEST(Balance, OppositeOffsetsKeepTheirWeights) {
    const auto result =
        balanced(std::vector{sample_at(0, 0, 1), sample_at(0.3, -0.2, 0.5), sample_at(-0.3, 0.2, 0.5)});
    EXPECT_DOUBLE_EQ(result[0].weight, 1);
    EXPECT_NEAR(result[1].weight, 0.5, 1e-12);
    EXPECT_NEAR(result[2].weight, 0.5, 1e-12);
}

// Slow and simple: no other weights have less error.
TEST(Balance, NoOtherWeightsHaveLessError) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> offset(-0.4, 0.4), weight(0.2, 1), change(-0.1, 0.1);
    for (int round = 0; round < 200; ++round) {
        std::vector<ViewSample> samples{sample_at(0, 0, 1)};
        for (int k = 0; k < 1 + round % 4; ++k)
            samples.push_back(sample_at(offset(random), offset(random), weight(random)));
        const auto result = balanced(samples);
        bool bounded = false; // if a weight would be negative, others are best
        for (std::size_t i = 0; i < samples.size(); ++i)
            bounded = bounded || result[i].weight <= 0.011 * samples[i].weight;
        if (bounded) continue;
        const std::vector<double> best = shares(result);
        for (int other = 0; other < 20; ++other) {
            std::vector<double> moved = best;
            for (std::size_t i = 1; i < moved.size(); ++i) {
                const double by = change(random);
                moved[i] += by;
                moved[0] -= by;
            }
            EXPECT_GE(error_of(samples, moved), error_of(samples, best) - 1e-6); // offsets are float
        }
    }
}

// A wall at a disparity that puts the rim views' pixels 0.3 px off, one to the right and one to the left. In the
// second view the left half was not rendered: there the mean of the others would be 0.11 px off.
TEST(Balance, AViewRenderedInPartMovesNothing) {
    TwoPlanes wall;
    wall.back_z = 100 / 3.3;
    const Windows windows = windows_of_size(60, 8);
    std::vector<View> views{wall.view(windows, {0, 0}), wall.view(windows, {1, 0}),
                            wall.view(windows, {-1, 0})};
    View part = views[2];
    for (std::size_t i = 0; i < windows.pixels(); ++i)
        if (i % 60 < 30)
            for (std::size_t k = 0; k < part.image.channels.size(); ++k) part.image.plane(k)[i] = 0;
    const WarpOptions options{.focal_px = 100, .radius = 1};
    Progress silent;
    const Ldi whole = warp(views, options, silent);
    const std::size_t left = whole.windows.index(Imath::V2i(15, 4)),
                      right = whole.windows.index(Imath::V2i(45, 4));
    EXPECT_NEAR(whole.dx[whole.pixel(left).front()], 0, 1e-5);
    views[2] = part;
    const Ldi ldi = warp(views, options, silent);
    EXPECT_NEAR(ldi.dx[ldi.pixel(right).front()], 0, 1e-5);
    const double w = std::exp(-0.5),
                 g = kernels::gradient_to_noise *
                     kernels::gradient_to_noise; // 0.3 px: one spread of nearness()
    const double plain = 0.3 * w / (1 + w), b = 0.3 * w / (1 / g + 0.09 * w), of_rim = w * (1 - 0.3 * b);
    EXPECT_NEAR(std::abs(double(ldi.dx[ldi.pixel(left).front()])), 0.3 * of_rim / (1 + of_rim), 1e-4);
    EXPECT_LT(0.3 * of_rim / (1 + of_rim), plain / 3);
}

// If nothing is missing, a surface seen by only some views is averaged as usual.
TEST(Balance, WhatIsHiddenIsNotMissing) {
    TwoPlanes scene;
    scene.front_covers = [](double x, double) { return x >= 20 && x < 40; };
    const Windows windows = windows_of_size(60, 8);
    const std::vector<View> views{scene.view(windows, {0, 0}), scene.view(windows, {0.2, 0})};
    const ReprojectedViews reprojected(views, 100, 20, 0);
    ViewSample wall = sample_at(0, 0, 1);
    wall.inverse_z = 0.1f;
    wall.x = 45; // the rim view has the front plane, 10 px to the left of where the centre has it, elsewhere
    wall.y = 4;
    EXPECT_FALSE(some_view_is_missing(reprojected, std::vector{wall}));
    wall.x = 1; // two pixels to the left of the rim view's frame
    EXPECT_FALSE(some_view_is_missing(reprojected, std::vector{wall}));
}

} // namespace
} // namespace sparselens
