#include "deep/flatten.h"
#include "measure/regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sparselens {
namespace {

// Every pixel against every jump.
std::vector<bool> silhouettes_reference(std::span<const float> c, int width, int height, double aspect) {
    std::vector<bool> result(c.size());
    const auto at = [&](int x, int y) { return double(c[std::size_t(y * width + x)]); };
    const auto grow = [&](int jx, int jy, double r) {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (std::pow(x - jx, 2) + std::pow((y - jy) / aspect, 2) <= r * r + 1e-9)
                    result[std::size_t(y * width + x)] = true;
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const auto &[dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
                if (x + dx >= width || y + dy >= height) continue;
                const double here = at(x, y), there = at(x + dx, y + dy);
                if (std::abs(here - there) <= 1) continue;
                const double r = std::max({std::abs(here), std::abs(there), 1.0});
                grow(x, y, r);
                grow(x + dx, y + dy, r);
            }
    return result;
}

void expect_silhouettes(std::span<const float> c, int width, int height, double aspect) {
    const auto bits = region_bits(c, width, height, aspect);
    const auto expected = silhouettes_reference(c, width, height, aspect);
    for (std::size_t i = 0; i < c.size(); ++i)
        EXPECT_EQ((bits[i] & silhouettes_bit) != 0, expected[i]) << "pixel " << i << " aspect " << aspect;
}

TEST(Regions, SizesOfBlur) {
    const std::vector<float> c{0, 0.99f, -0.99f, 1, -1, 8, -8, 8.01f, -8.01f};
    const auto bits = region_bits(c, 1, 9);
    const std::vector<int> expected{1, 1, 1, 0, 0, 0, 0, 2, 2};
    for (std::size_t i = 0; i < c.size(); ++i)
        EXPECT_EQ(bits[i] & (in_focus_bit | blurred_bit), expected[i]) << c[i];
}

TEST(Regions, SilhouetteReachesAsFarAsTheLargerBlurOnBothSides) {
    // c = 0 | 5 between columns 19 and 20: columns 19 - 5 to 20 + 5.
    std::vector<float> c(40 * 3);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = i % 40 < 20 ? 0.0f : 5.0f;
    const auto bits = region_bits(c, 40, 3);
    for (std::size_t i = 0; i < c.size(); ++i)
        EXPECT_EQ((bits[i] & silhouettes_bit) != 0, i % 40 >= 14 && i % 40 <= 25) << i;
}

TEST(Regions, AJumpOfOnePixelIsNone) {
    const std::vector<float> steps{0, 1, 2, 3, 2, 1, 0};
    for (const auto b : region_bits(steps, 7, 1)) EXPECT_FALSE(b & silhouettes_bit);
    const std::vector<float> steep{-0.6f, 0.6f, 0.6f, 0.6f};
    const auto bits = region_bits(steep, 4, 1); // reach: at least 1
    const std::vector<bool> expected{true, true, true, false};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ((bits[i] & silhouettes_bit) != 0, expected[i]);
}

TEST(Regions, AgreeWithEveryPixelAgainstEveryJump) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> size(-6, 6);
    std::bernoulli_distribution other(0.02);
    for (const double aspect : {1.0, 2.0, 0.5}) {
        std::vector<float> c(47 * 31);
        float value = 0;
        for (float &v : c) v = value = other(generator) ? size(generator) : value;
        expect_silhouettes(c, 47, 31, aspect);
    }
}

TEST(Regions, HugeBlurCoversAll) {
    for (const float huge : {1e4f, 3e38f, std::numeric_limits<float>::infinity()})
        for (const double aspect : {1.0, 4.0, 0.25}) {
            std::vector<float> c(60 * 40); // the only jumps are in one corner
            c.front() = -huge;
            const auto bits = region_bits(c, 60, 40, aspect);
            EXPECT_EQ(bits.front(), blurred_bit | silhouettes_bit);
            for (std::size_t i = 1; i < bits.size(); ++i)
                ASSERT_EQ(bits[i], in_focus_bit | silhouettes_bit) << i;
        }
}

TEST(Regions, FrontSamplesOfAnLdi) {
    const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
    Ldi ldi;
    ldi.windows = windows_of_size(3, 1);
    ldi.begin = {0, 2, 2, 3};
    ldi.z = {2.5f, 10, std::numeric_limits<float>::infinity()};
    const auto c = front_circles_of_confusion(ldi, lens);
    EXPECT_FLOAT_EQ(c[0], -7.68f);
    EXPECT_FLOAT_EQ(c[1], 7.68f); // empty: background at infinity
    EXPECT_FLOAT_EQ(c[2], 7.68f);
}

TEST(Regions, OverAnotherDataWindow) {
    Windows from = windows_of_size(4, 4), target = windows_of_size(4, 4);
    from.data = {{1, 1}, {2, 2}};
    target.display = target.data = {{100, 0}, {103, 3}};
    const auto bits = bits_over(std::vector<std::uint8_t>{1, 2, 3, 4}, from, target);
    EXPECT_EQ(bits, (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 2, 0, 0, 3, 4, 0, 0, 0, 0, 0}));
}

} // namespace
} // namespace sparselens
