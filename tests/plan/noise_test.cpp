#include "base/light.h"
#include "plan/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace sparselens {
namespace {

constexpr ThinLens lens{.radius = 0.1, .focal_px = 100, .focus = 5};

// Scene-linear value whose tone-mapped value is t.
float untoned(double t) {
    const double v = std::pow(t, 2.2);
    return float(v / (1 - v));
}

double noise_of(const std::function<double(int x, int y)> &tone_mapped_value, float z = 5) {
    const Windows windows = windows_of_size(130, 98);
    Image image(windows, rgba_channels());
    for (int y = 0; y < 98; ++y)
        for (int x = 0; x < 130; ++x) {
            const float value = untoned(tone_mapped_value(x, y));
            for (std::size_t k = 0; k < 3; ++k) image.at(k, x, y) = value;
        }
    const std::vector<float> depth(windows.pixels(), z);
    const std::vector<double> noise = noise_in_lens_picture(image, depth, lens);
    return std::accumulate(noise.begin(), noise.end(), 0.0) / double(noise.size());
}

TEST(Noise, CleanPicturesHaveNone) {
    EXPECT_LT(noise_of([](int, int) { return 0.5; }), 1e-9);
    EXPECT_LT(noise_of([](int x, int) { return 0.2 + 0.004 * x; }), 1e-9);
    EXPECT_LT(noise_of([](int x, int y) { return (x / 5 + y / 7) % 2 == 0 ? 0.3 : 0.7; }), 2e-6);
}

TEST(Noise, GaussianNoiseIsMeasured) {
    for (const double deviation : {0.003, 0.01, 0.04}) {
        std::mt19937 random(5);
        std::normal_distribution<double> noise(0.5, deviation);
        EXPECT_NEAR(noise_of([&](int, int) { return noise(random); }) / (deviation * deviation), 1, 0.2);
    }
}

// Random blades, upright or at 45 degrees, differ from pixel to pixel across them, but not along them.
TEST(Noise, BladesAreNone) {
    for (const int slant : {0, 1}) {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> value(0.2, 0.8);
        std::vector<double> across(600);
        for (double &v : across) v = value(random);
        EXPECT_LT(noise_of([&](int x, int y) { return across[std::size_t(x + slant * y)]; }), 1e-5) << slant;
    }
}

// Aliased texture: one block in four looks like noise.
TEST(Noise, WhatLooksLikeNoiseHereAndThereIsNone) {
    const auto with_a_noisy_block_in = [](int blocks) {
        std::mt19937 random(5);
        std::normal_distribution<double> noise(0.5, 0.02);
        return noise_of([&](int x, int y) {
            const double value = noise(random);
            return ((x - 1) / 8 + 2 * ((y - 1) / 8)) % blocks == 0 ? value : 0.5;
        });
    };
    EXPECT_LT(with_a_noisy_block_in(4), 1e-6);
    EXPECT_GT(with_a_noisy_block_in(1), 3e-4);
}

// Only the left half has noise, which is found there, except in the blocks beside the border.
TEST(Noise, IsFoundWhereItIs) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.5, 0.02);
    Image image(windows_of_size(130, 98), rgba_channels());
    for (int y = 0; y < 98; ++y)
        for (int x = 0; x < 130; ++x) {
            const float value = untoned(x < 65 ? noise(random) : 0.5);
            for (std::size_t k = 0; k < 3; ++k) image.at(k, x, y) = value;
        }
    const auto found = noise_in_lens_picture(image, std::vector<float>(130 * 98, 5.0f), lens);
    double sum = 0;
    for (int y = 0; y < 98; ++y)
        for (int x = 0; x < 130; ++x) {
            if (x < 48) sum += found[std::size_t(y * 130 + x)];
            if (x >= 81) {
                EXPECT_EQ(found[std::size_t(y * 130 + x)], 0);
            }
        }
    EXPECT_NEAR(sum / (48 * 98) / (0.02 * 0.02), 1, 0.2);
}

// c = R F / d (z - d) / z: 2 px at z = inf, which averages over 4 pi pixels.
TEST(Noise, BlurAveragesIt) {
    const auto noise_at = [](float z) {
        std::mt19937 random(5);
        std::normal_distribution<double> noise(0.5, 0.02);
        return noise_of([&](int, int) { return noise(random); }, z);
    };
    EXPECT_NEAR(noise_at(5) / noise_at(INFINITY), 4 * M_PI, 1e-6);
}

TEST(Noise, IsTakenAsGiven) {
    const Image image(windows_of_size(40, 40), rgba_channels());
    const std::vector<float> z(1600, 5.0f);
    for (const double noise : noise_in_lens_picture(image, z, lens, 0.1)) EXPECT_DOUBLE_EQ(noise, 0.1 * 0.1);
    for (const double noise : noise_in_lens_picture(image, z, lens)) EXPECT_EQ(noise, 0);
    EXPECT_EQ(noise_in_lens_picture(Image(windows_of_size(3, 2), rgba_channels()),
                                    std::vector<float>(6, 5.0f), lens),
              std::vector<double>(6, 0.0));
}

} // namespace
} // namespace sparselens
