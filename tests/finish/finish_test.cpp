// The limits of finish_layer(): a correct gathered picture, one of another scene, and infinitely many rays.
#include "finish/synthetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sparselens {
namespace {

const ArrayGrid grid(160, 90);
const Colours truth = synthetic_truth(grid);

TEST(Finish, WhatIsRightStays) {
    const FinishedLayer result = finished(layer_of(grid, truth, truth, {4, 4}));
    EXPECT_GT(decibels_of(result.picture, truth), 55);
}

TEST(Finish, WhatIsWrongGetsNearerThanBoth) {
    const Colours wrong = blurred(truth, grid, 2);
    for (const double samples : {8.0, 40.0, 160.0}) {
        const LayerToFinish layer = layer_of(grid, truth, wrong, {samples, samples});
        const double rays = decibels_of(mean_of(layer.rays, layer.samples.mean), truth);
        EXPECT_GT(decibels_of(finished(layer).picture, truth),
                  std::max(rays, decibels_of(wrong, truth)) + 0.5)
            << samples;
    }
}

TEST(Finish, AGatheredPictureOfAnotherSceneCostsLittle) {
    const Colours other = synthetic_truth(grid, 1), nothing(3, Values(grid.size(), 0.5f));
    for (const double samples : {10.0, 160.0}) {
        const double by_other = decibels_of(
                         finished(layer_of(grid, truth, other, {samples, samples})).picture, truth),
                     by_nothing = decibels_of(
                         finished(layer_of(grid, truth, nothing, {samples, samples})).picture, truth);
        EXPECT_GT(by_other, by_nothing - 0.2) << samples;
    }
}

TEST(Finish, ManyRaysDecide) {
    const LayerToFinish layer = layer_of(grid, truth, synthetic_truth(grid, 1), {2048, 2048});
    EXPECT_GT(decibels_of(finished(layer).picture, truth),
              decibels_of(mean_of(layer.rays, layer.samples.mean), truth) - 0.05);
}

// The brighter a pixel, the rarer its ray: a pixel that is bright in only one render must not stay.
TEST(Finish, AFireflyOfOneRenderIsNotBelieved) {
    LayerToFinish layer = layer_of(grid, truth, truth, {16, 16});
    for (Values &channel : layer.rays[0]) channel[grid.index(Position(100, 70))] = 500;
    const FinishedLayer result = finished(layer);
    for (const Values &channel : result.picture) EXPECT_LT(channel[grid.index(Position(100, 70))], 2);
}

TEST(Finish, TwiceTheLightGivesExactlyTwice) {
    LayerToFinish layer = layer_of(grid, truth, blurred(truth, grid, 2), {16, 16});
    layer.given = {{blurred(layer.rays[0], grid, 1), blurred(layer.rays[1], grid, 1)}};
    const FinishedLayer once = finished(layer);
    for (Halves *halves : {&layer.rays, &layer.given[0]})
        for (Colours &half : *halves)
            for (Values &channel : half)
                for (float &v : channel) v *= 2;
    for (Values &channel : layer.gathered)
        for (float &v : channel) v *= 2;
    const FinishedLayer twice = finished(layer);
    EXPECT_GT(decibels_of(once.picture, truth), decibels_of(blurred(truth, grid, 2), truth) + 1);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < grid.size(); ++i)
            ASSERT_EQ(twice.picture[c][i], 2 * once.picture[c][i]) << i;
}

// A lamp's disc before a sky without noise: most pixels of both renders miss the lamp, and equal the gathered picture.
TEST(Finish, FewRaysOfALampAreNoSieve) {
    const Colours sky(3, Values(grid.size(), 0.2f));
    LayerToFinish layer{grid, sky, {sky, sky}, std::array<double, 2>{16, 16}};
    const auto in_disc = [](std::size_t i) {
        return std::hypot(grid.position(i).column - 80, grid.position(i).row - 45) < 12;
    };
    std::mt19937 random(1);
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t i = 0; i < grid.size(); ++i)
            if (in_disc(i) && random() % 2 == 0)
                for (Values &channel : layer.rays[k]) channel[i] = 0.6f;
    const FinishedLayer result = finished(layer);
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Position at = grid.position(i);
        if (in_disc(i)) {
            EXPECT_NE(result.picture[1][i], 0.2f) << i;
        } else if (std::hypot(at.column - 80, at.row - 45) > 16) {
            EXPECT_EQ(result.picture[1][i], 0.2f) << i;
        }
    }
}

TEST(Finish, AnyFiniteValueGivesFiniteOnes) {
    for (const float huge : {65504.0f, -65504.0f, 1e8f}) {
        LayerToFinish layer = layer_of(grid, truth, truth, {16, 16});
        layer.rays[0][0][2000] = layer.rays[1][1][4000] = layer.gathered[2][6000] = huge;
        const FinishedLayer result = finished(layer);
        for (const Values &channel : result.picture)
            for (const float v : channel) ASSERT_TRUE(std::isfinite(v)) << huge;
    }
}

TEST(Finish, BlackStaysBlack) {
    const Colours black(3, Values(grid.size(), 0.0f));
    const FinishedLayer result = finished({grid, black, {black, black}});
    EXPECT_EQ(result.picture, black);
}

TEST(Finish, WhatOthersMadeIsTakenWhereItIsNearer) {
    LayerToFinish layer = layer_of(grid, truth, blurred(truth, grid, 3), {8, 8});
    const double without = decibels_of(finished(layer).picture, truth);
    layer.given.push_back({truth, truth});
    EXPECT_GT(decibels_of(finished(layer).picture, truth), without + 3);
}

// dof-finish offers given pictures before the rays. Otherwise noisier candidates correct the same pixels.
TEST(Finish, WhatIsGivenIsOfferedBeforeTheRays) {
    const Colours other = synthetic_truth(grid, 1);
    LayerToFinish layer = layer_of(grid, other, blurred(other, grid, 3), {64, 16});
    const double without = decibels_of(finished(layer).picture, other);
    layer.given.push_back({blurred(rays_of(other, 64, 5), grid, 1), blurred(rays_of(other, 16, 6), grid, 1)});
    EXPECT_GT(decibels_of(finished(layer).picture, other), without + 0.1);
}

// The gathered picture is wrong nearly everywhere; what a denoiser leaves of each render is better.
TEST(Finish, IsNotWorseThanWhatIsGiven) {
    for (const auto &samples : {std::array<double, 2>{2, 2}, {8, 2}, {8, 8}}) {
        LayerToFinish layer = layer_of(grid, truth, blurred(truth, grid, 4), samples);
        const Halves denoised{rays_of(truth, 16 * samples[0], 5), rays_of(truth, 16 * samples[1], 6)};
        layer.given.push_back(denoised);
        EXPECT_GT(decibels_of(finished(layer).picture, truth),
                  decibels_of(mean_of(denoised, samples), truth) - 0.1)
            << samples[0] << ' ' << samples[1];
    }
}

// The frames around may show something else: a frame's own rays test the candidates made of their means.
TEST(Finish, WrongMeansWithFramesAroundCostLittle) {
    LayerToFinish layer = layer_of(grid, truth, blurred(truth, grid, 3), {40, 40});
    const Colours other = synthetic_truth(grid, 1);
    layer.averaged = {other, other};
    EXPECT_GT(decibels_of(finished(layer).picture, truth), decibels_of(layer.gathered, truth) - 1);
}

} // namespace
} // namespace sparselens
