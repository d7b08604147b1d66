// The error without the noise of two references: closed forms, and known noise.
#include "measure/without_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sparselens {
namespace {

// The scene-linear value whose tone-mapped value is v, in [0, 1).
float linear(double v) {
    const double x = std::pow(v, 2.2);
    return float(x / (1 - x));
}

Image grey(double tone, double noise = 0, unsigned seed = 0) {
    Image image(windows_of_size(96, 64), rgba_channels());
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < image.windows.pixels(); ++i) {
        const float v = linear(tone + noise * normal(random)); // the same in all channels
        for (std::size_t c = 0; c < 4; ++c) image.plane(c)[i] = c == 3 ? 1 : v;
    }
    return image;
}

TEST(WithoutNoise, TheMeanOfTheProduct) {
    const auto found = error_without_noise(grey(0.5), grey(0.4), grey(0.7));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].mean_square, 0.1 * -0.2, 1e-7);
    EXPECT_NEAR(error_without_noise(grey(0.5), grey(0.4), grey(0.4))[0].decibels(), 20, 1e-4);
}

// The references' noise of 26 dB would hide an error of 34 dB.
TEST(WithoutNoise, NoiseOfTheReferencesIsNotInIt) {
    const ErrorWithoutNoise found =
        error_without_noise(grey(0.52), grey(0.5, 0.05, 1), grey(0.5, 0.05, 2))[0];
    EXPECT_TRUE(found.is_told());
    EXPECT_NEAR(found.decibels(), 34, 1.2); // three standard deviations: 0.05^2 / 78 of 0.02^2
    EXPECT_LT(found.at_least(), found.decibels());
}

TEST(WithoutNoise, TheDeviationIsThatOfManyPairs) {
    const Image truth = grey(0.5);
    double squares = 0, deviation = 0;
    constexpr unsigned pairs = 40;
    for (unsigned k = 0; k < pairs; ++k) {
        const auto found =
            error_without_noise(truth, grey(0.5, 0.05, 2 * k + 10), grey(0.5, 0.05, 2 * k + 11))[0];
        squares += found.mean_square * found.mean_square / pairs;
        deviation += found.deviation / pairs;
        EXPECT_LT(std::abs(found.mean_square), 4 * found.deviation);
    }
    EXPECT_NEAR(deviation, std::sqrt(squares), 0.35 * std::sqrt(squares)); // 3 deviations with 40 values
}

TEST(WithoutNoise, ByRegionAndWithoutWhatIsNotFinite) {
    Image image = grey(0.5), reference = grey(0.5);
    image.plane(1)[5] = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t c = 0; c < 3; ++c) image.plane(c)[7] = linear(0.9);
    std::vector<std::uint8_t> bits(image.windows.pixels(), 1);
    bits[7] = 2;
    const auto found = error_without_noise(image, reference, reference, bits, 2);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_NEAR(found[1].mean_square, 0, 1e-12);
    EXPECT_NEAR(found[2].mean_square, 0.16, 1e-6);
    EXPECT_NEAR(found[0].mean_square, 0.16 / double(image.windows.pixels() - 1), 1e-8);
}

} // namespace
} // namespace sparselens
