// The estimated error compared with the true one, where the truth is known.
#include "finish/error_estimate.h"
#include "finish/synthetic.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

const ArrayGrid grid(240, 135);
const Colours truth = synthetic_truth(grid);

ErrorEstimate estimated(const LayerToFinish &layer, const FinishedLayer &finished) {
    return estimate_error(finished, layer.rays, layer.samples, grid);
}

TEST(ErrorEstimate, LiesNearTheTrueError) {
    for (const auto &samples : {std::array<double, 2>{40, 40}, {64, 16}, {16, 64}, {320, 320}})
        for (const int blur : {1, 3}) {
            const LayerToFinish layer = layer_of(grid, truth, blurred(truth, grid, blur), samples);
            const FinishedLayer result = finished(layer);
            const ErrorEstimate error = estimated(layer, result);
            const auto known = decibels(error);
            const double is = decibels_of(result.picture, truth);
            // Renders may be unable to tell the small error of a good picture: then it lies within the uncertainty.
            ASSERT_TRUE(known || blur == 1) << samples[0] << ' ' << blur;
            if (known)
                EXPECT_NEAR(*known, is, 2) << samples[0] << ' ' << blur;
            else
                EXPECT_NEAR(error.mean, std::pow(10, -is / 10), 2 * error.standard_deviation);
            // At most 1 dB too good, and by its standard deviation.
            EXPECT_LT(-10 * std::log10(error.mean + error.standard_deviation), is + 1)
                << samples[0] << ' ' << blur;
        }
}

TEST(ErrorEstimate, IsUnknownWithinTwoDeviations) {
    ErrorEstimate error;
    error.mean = 1e-4;
    error.standard_deviation = 0.49e-4;
    ASSERT_TRUE(decibels(error));
    EXPECT_NEAR(*decibels(error), 40, 1e-9);
    error.standard_deviation = 0.51e-4;
    EXPECT_FALSE(decibels(error));
}

// From no gain of a second render to one that is larger than noise can have.
TEST(ErrorEstimate, FallsByAQuarterToOne) {
    ErrorEstimate error;
    error.mean = 1e-4;
    for (const auto &[times, fall] : {std::array{1.0, 0.25}, {std::sqrt(2), 0.5}, {2.0, 1.0}, {100.0, 1.0}}) {
        error.of_one = times * error.mean;
        EXPECT_NEAR(fall_of(error, {16, 16}), fall, 1e-9) << times;
    }
}

// Both renders are exact, so the difference of the pictures makes the error: half of its square in a picture of one
// render, n m / (n + m)^2 of it in the picture of both.
TEST(ErrorEstimate, TheNoiseThatIsLeftDependsOnTheSamples) {
    const Colours zero(3, Values(grid.size(), 0.0f)), one(3, Values(grid.size(), 1.0f));
    const ErrorEstimate error =
        estimate_error({one, {one, zero}, {}}, {one, one}, std::array<double, 2>{64, 16}, grid);
    EXPECT_NEAR(error.mean / error.of_one, 64.0 * 16 / (80 * 80) / 0.5, 1e-6);
}

TEST(ErrorEstimate, EachPixelHasItsSamples) {
    const Colours zero(3, Values(grid.size(), 0.0f)), one(3, Values(grid.size(), 1.0f));
    RayCounts samples({1, 1}, {Values(grid.size(), 64.0f), Values(grid.size(), 64.0f)});
    for (std::size_t i = 0; i < grid.size() / 2; ++i) samples.by_pixel[1][i] = 16;
    const ErrorEstimate error = estimate_error({one, {one, zero}, {}}, {one, one}, samples, grid);
    const double share = double(grid.size() / 2) / double(grid.size());
    EXPECT_NEAR(error.mean / error.of_one, (0.16 * share + 0.25 * (1 - share)) / 0.5, 1e-6);
}

// The estimate's map is large where the picture is wrong.
TEST(ErrorEstimate, TheMapShowsWhere) {
    Colours wrong = truth;
    for (int y = 30; y < 60; ++y)
        for (int x = 100; x < 130; ++x) wrong[1][grid.index(Position(x, y))] += 0.2f;
    const LayerToFinish layer = layer_of(grid, truth, wrong, {8, 8});
    const ErrorEstimate error = estimated(layer, {wrong, {wrong, wrong}, {}});
    double inside = 0, outside = 0;
    for (int y = 32; y < 58; ++y)
        for (int x = 102; x < 128; ++x) {
            inside += double(error.map[grid.index(Position(x, y))]);
            outside += double(error.map[grid.index(Position(x - 70, y))]);
        }
    EXPECT_GT(inside, 5 * outside);
}

TEST(ErrorEstimate, WhatIsTooSmallToTellIsNotTold) {
    const LayerToFinish layer = layer_of(grid, truth, truth, {4, 4});
    const ErrorEstimate error = estimated(layer, {truth, {truth, truth}, {}});
    EXPECT_FALSE(decibels(error));
    EXPECT_FALSE(times_the_rays(error, layer.samples.mean, 60));
}

TEST(ErrorEstimate, SaysHowManyRaysAGoalTakes) {
    const std::array<double, 2> samples{32, 32};
    const ErrorEstimate error{{}, 1e-4, 1e-6, 2e-4}; // twice the rays halve the error
    EXPECT_EQ(times_the_rays(error, samples, 39).value(), 1);
    EXPECT_NEAR(times_the_rays(error, samples, 43.01).value(), 2, 0.01);
    const ErrorEstimate slow{{}, 1e-4, 1e-6, 1e-4}; // it did not fall with more rays
    EXPECT_GT(times_the_rays(slow, samples, 43.01).value(), 10);
}

} // namespace
} // namespace sparselens
