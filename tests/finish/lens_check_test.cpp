// Mistakes between a gathered picture and rays are named if they exist, and only then.
#include "finish/lens_check.h"
#include "finish/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace sparselens {
namespace {

const ArrayGrid grid(160, 90);
const Colours truth = blurred(synthetic_truth(grid), grid, 1);

Colours times(Colours colours, float factor) {
    for (Values &channel : colours)
        for (float &v : channel) v *= factor;
    return colours;
}

// The picture moved by half a pixel to the right, or down.
Colours moved(const Colours &colours, int dx, int dy) {
    Colours result = colours;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const Position at = grid.position(i), from(std::max(at.column - dx, 0), std::max(at.row - dy, 0));
            result[c][i] = (colours[c][i] + colours[c][grid.index(from)]) / 2;
        }
    return result;
}

LensMistakes found(const Colours &gathered, double samples = 16) {
    return check_lens(layer_of(grid, truth, gathered, {samples, samples}));
}

TEST(LensCheck, NothingIsSaidOfGoodPictures) {
    for (const double samples : {1.0, 16.0, 1024.0})
        for (const int blur : {0, 1, 3})
            EXPECT_EQ(found(blurred(truth, grid, blur), samples).warnings(), std::vector<std::string>())
                << samples << ' ' << blur;
}

TEST(LensCheck, ExposureIsNamed) {
    for (const float factor : {0.5f, 0.9f, 1.1f, 2.0f}) {
        const LensMistakes mistakes = found(times(truth, factor));
        ASSERT_TRUE(mistakes.brightness) << factor;
        EXPECT_NEAR(*mistakes.brightness, factor, 0.02 * double(factor));
        EXPECT_EQ(mistakes.warnings().size(), 1u);
    }
}

TEST(LensCheck, HalfAPixelIsNamed) {
    const LensMistakes right = found(moved(truth, 1, 0)), below = found(moved(truth, 0, 1));
    ASSERT_TRUE(right.right);
    EXPECT_NEAR(*right.right, 0.5, 0.2);
    EXPECT_FALSE(right.down || right.brightness);
    ASSERT_TRUE(below.down);
    EXPECT_NEAR(*below.down, 0.5, 0.2);
    EXPECT_FALSE(below.right || below.brightness);
    EXPECT_NE(below.warnings()[0].find("bottom"), std::string::npos);
}

// A lamp beyond the frame, whose light the gathered picture lacks, is not a different exposure.
TEST(LensCheck, LightThatTheGatheredPictureLacksIsNoExposure) {
    Colours bright = truth;
    for (std::size_t i = 0; i < grid.size(); ++i)
        if (const Position at = grid.position(i); at.column < 40 && at.row < 60)
            for (Values &channel : bright) channel[i] *= 3;
    EXPECT_EQ(check_lens(layer_of(grid, bright, truth, {16, 16})).warnings(), std::vector<std::string>());
}

// Discs of lamps: one ray of a thousand hits them, so that most pixels of few rays show none.
TEST(LensCheck, LampsThatFewRaysMissAreNoExposure) {
    for (const double samples : {4.0, 8.0, 16.0, 32.0, 256.0}) {
        LayerToFinish layer = layer_of(grid, truth, truth, {samples, samples});
        for (Colours *colours : {&layer.gathered, &layer.rays[0], &layer.rays[1]})
            for (Values &channel : *colours)
                for (float &v : channel) v *= 0.05f;
        std::mt19937 random(7);
        std::poisson_distribution<int> hits(samples / 1000);
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const Position at = grid.position(i);
            if ((at.column / 40 + at.row / 30) % 2 == 0) continue;
            for (Values &channel : layer.gathered) channel[i] += 0.4f;
            for (Colours &rays : layer.rays) {
                const float light = 0.4f * 1000 / float(samples) * float(hits(random));
                for (Values &channel : rays) channel[i] += light;
            }
        }
        EXPECT_EQ(check_lens(layer).warnings(), std::vector<std::string>()) << samples;
        for (Values &channel : layer.gathered)
            for (float &v : channel) v *= 2;
        EXPECT_TRUE(check_lens(layer).brightness) << samples;
    }
}

// Each lamp of the gathered picture lacks a pixel at its right.
TEST(LensCheck, WhatLampsLackIsNoShift) {
    LayerToFinish layer = layer_of(grid, truth, truth, {16, 16});
    for (int y = 8; y < 90; y += 16)
        for (int x = 8; x < 160; x += 16)
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t lamp = grid.index(Position(x, y));
                for (Values *values : {&layer.gathered[c], &layer.rays[0][c], &layer.rays[1][c]})
                    (*values)[lamp] = 100;
                for (Colours &rays : layer.rays) rays[c][lamp + 1] = 40;
            }
    EXPECT_EQ(check_lens(layer).warnings(), std::vector<std::string>());
}

TEST(LensCheck, ExposuresThatDifferBetweenTheRendersAreNotNamed) {
    EXPECT_EQ(check_lens({grid, truth, {times(truth, 1.1f), times(truth, 1.3f)}}).warnings(),
              std::vector<std::string>());
}

TEST(LensCheck, BlackAndTinyPicturesAreFine) {
    const Colours black(3, Values(grid.size(), 0.0f));
    EXPECT_TRUE(check_lens({grid, black, {black, black}}).warnings().empty());
    const Colours dot(3, Values(1, 1.0f));
    EXPECT_TRUE(check_lens({ArrayGrid(1, 1), dot, {dot, dot}}).warnings().empty());
}

// Channel 1 of two renders and of a gathered picture.
std::vector<half> plane(const Colours &colours) { return {colours[1].begin(), colours[1].end()}; }
NoiseOfTwo noise(const Colours &first, const Colours &second, const Colours &gathered) {
    return noise_of_two(plane(first), plane(second), plane(gathered), grid);
}
bool smooth(const NoiseOfTwo &found) { return found.alike > FinishTuning::noise_alike; }

TEST(NoiseOfTwo, GoodRendersHaveNoiseBySamples) {
    for (const auto &samples :
         {std::array{1.0, 1.0}, {16, 16}, {64, 16}, {16, 1024}, {1024, 1024}, {65536, 65536}})
        for (const int blur : {0, 1, 8}) {
            const Colours gathered = blurred(truth, grid, blur);
            const NoiseOfTwo found =
                noise(rays_of(truth, samples[0], 1), rays_of(truth, samples[1], 2), gathered);
            EXPECT_FALSE(found.same() || smooth(found)) << samples[0] << ' ' << blur;
            const double all = samples[0] + samples[1];
            for (std::size_t k = 0; k < 2; ++k)
                EXPECT_NEAR(found.of_each[k], samples[1 - k] / all, 0.15 * samples[1 - k] / all + 0.01)
                    << samples[k] << ' ' << blur;
        }
}

// Equal in half of the pixels, or but for a factor.
TEST(NoiseOfTwo, TheSameNoiseIsToldThoughRendersDiffer) {
    const Colours first = rays_of(truth, 16, 1);
    Colours half_of_it = rays_of(truth, 16, 2);
    for (std::size_t c = 0; c < 3; ++c) std::copy_n(first[c].begin(), grid.size() / 2, half_of_it[c].begin());
    EXPECT_TRUE(noise(first, half_of_it, truth).same());
    EXPECT_TRUE(noise(half_of_it, first, truth).same());
    EXPECT_TRUE(noise(first, times(first, 1.0001f), truth).same());
    EXPECT_TRUE(noise(times(first, 1.2f), first, truth).same());
}

// Multiples from nearly 1 to three stops, of few samples and many.
TEST(NoiseOfTwo, MultiplesAreTheSameNoise) {
    for (const double samples : {4.0, 64.0, 1024.0})
        for (const float factor : {0.25f, 0.9f, 0.997f, 1.0005f, 1.003f, 1.02f, 2.0f, 8.0f}) {
            const Colours first = rays_of(truth, samples, 1);
            EXPECT_TRUE(noise(first, times(first, factor), blurred(truth, grid, 1)).same())
                << samples << ' ' << factor;
        }
}

// A rectangle of many samples where the gathered picture lacks a lamp or a texture: the renders are good.
TEST(NoiseOfTwo, AWrongGatheredPictureDoesNotMakeNoiseTheSame) {
    for (const auto &size : {Imath::V2i(48, 8), {8, 8}, {3, 3}}) {
        const ArrayGrid small(size.x, size.y);
        for (const float lamp : {0.0f, 20.0f, 500.0f})
            for (const double samples : {1.0, 50.0, 500.0, 5000.0})
                for (std::uint32_t seed = 1; seed < 20; ++seed) {
                    Colours there(3, Values(small.size()));
                    for (std::size_t i = 0; i < small.size(); ++i)
                        for (Values &channel : there)
                            channel[i] = 0.3f + 0.1f * std::sin(float(small.position(i).column)) +
                                         (i == 11 ? lamp : 0);
                    const Colours wrong(3, Values(small.size(), 0.3f));
                    const NoiseOfTwo found =
                        noise_of_two(plane(rays_of(there, samples, 2 * seed)),
                                     plane(rays_of(there, samples, 2 * seed + 1)), plane(wrong), small);
                    ASSERT_FALSE(found.same()) << size << ' ' << lamp << ' ' << samples << ' ' << seed;
                }
    }
}

// Missing and infinite values tell nothing.
TEST(NoiseOfTwo, RendersWithoutNoiseAreTold) {
    Colours first = rays_of(truth, 16, 1), second = rays_of(truth, 16, 2);
    std::fill_n(first[1].begin(), grid.size() / 4, std::numeric_limits<float>::quiet_NaN());
    std::fill_n(second[1].end() - 2000, 2000, std::numeric_limits<float>::infinity());
    EXPECT_FALSE(smooth(noise(first, second, truth)));
    EXPECT_NEAR(noise(first, second, truth).of_each[0], 0.5, 0.05);
    EXPECT_TRUE(smooth(noise(blurred(rays_of(truth, 16, 1), grid, 2), blurred(second, grid, 2), truth)));
    const NoiseOfTwo gathered = noise(first, blurred(truth, grid, 1), blurred(truth, grid, 1));
    EXPECT_NEAR(gathered.of_each[0], 1, 0.01);
    EXPECT_NEAR(gathered.of_each[1], 0, 0.01);
}

} // namespace
} // namespace sparselens
