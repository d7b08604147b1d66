#include "measure/image_error.h"
#include "measure/ssim_reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sparselens {
namespace {

std::vector<float> random_values(std::size_t count, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> values(count);
    for (float &v : values) v = uniform(generator);
    return values;
}

TEST(Ssim, AgreesWithThePaperWindowByWindow) {
    const int width = 40, height = 27;
    const auto a = random_values(std::size_t(width * height), 1);
    auto b = random_values(std::size_t(width * height), 2);
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = 0.7f * a[i] + 0.3f * b[i];
    const SsimMap map = ssim_map(a, b, width, height);
    const auto expected = ssim_reference(a, b, width, height);
    ASSERT_EQ(map.width, 30);
    ASSERT_EQ(map.height, 17);
    EXPECT_EQ(map.centre_x, 5);
    EXPECT_EQ(map.centre_y, 5);
    ASSERT_EQ(map.values.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(map.values[i], expected[i], 1e-10);
}

TEST(Ssim, EqualPicturesAreOne) {
    const auto a = random_values(20 * 20, 3);
    for (const double value : ssim_map(a, a, 20, 20).values) EXPECT_DOUBLE_EQ(value, 1);
}

TEST(Ssim, ConstantPicturesDifferByTheirLuminanceAlone) {
    const std::vector<float> a(144, 0.25f), b(144, 0.75f);
    const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
    for (const double value : ssim_map(a, b, 12, 12).values) EXPECT_NEAR(value, expected, 1e-12);
}

TEST(Ssim, ANaNSpoilsTheWindowsThatHoldItAndNoOthers) {
    const int width = 40, height = 30, bad_x = 17, bad_y = 12;
    auto a = random_values(std::size_t(width * height), 4);
    const auto b = random_values(std::size_t(width * height), 5);
    const SsimMap clean = ssim_map(a, b, width, height);
    a[std::size_t(bad_y * width + bad_x)] = std::numeric_limits<float>::quiet_NaN();
    const SsimMap map = ssim_map(a, b, width, height);
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const auto i = std::size_t(y * map.width + x);
            const bool holds = x <= bad_x && bad_x < x + 11 && y <= bad_y && bad_y < y + 11;
            if (holds)
                EXPECT_TRUE(std::isnan(map.values[i]));
            else
                EXPECT_EQ(map.values[i], clean.values[i]);
        }
}

TEST(Ssim, WindowOfASmallPictureIsThePicture) {
    const std::vector<float> one{0.2f}, other{0.6f};
    const SsimMap pixel = ssim_map(one, other, 1, 1);
    ASSERT_EQ(pixel.values.size(), 1u);
    EXPECT_EQ(pixel.centre_x, 0);
    EXPECT_NEAR(pixel.values[0], (2 * 0.12 + 1e-4) / (0.04 + 0.36 + 1e-4), 1e-7); // 0.2f is not 0.2

    const auto a = random_values(4 * 30, 6), b = random_values(4 * 30, 7);
    const SsimMap narrow = ssim_map(a, b, 4, 30);
    EXPECT_EQ(narrow.width, 1);
    EXPECT_EQ(narrow.height, 20);
    EXPECT_EQ(narrow.centre_x, 2);
}

TEST(Ssim, WindowWeightsSumToOneAndAreSymmetric) {
    for (const int size : {1, 2, 7, 11}) {
        const auto w = ssim_window(size);
        double sum = 0;
        for (std::size_t i = 0; i < w.size(); ++i) {
            sum += w[i];
            EXPECT_DOUBLE_EQ(w[i], w[w.size() - 1 - i]);
        }
        EXPECT_NEAR(sum, 1, 1e-15);
    }
    const auto w = ssim_window(11);
    EXPECT_NEAR(w[5] / w[8], std::exp(2), 1e-12); // 3 pixels are 2 sigma
}

} // namespace
} // namespace sparselens
