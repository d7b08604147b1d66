#include "dof/lens/visibility.h"
#include "kernels/lens_rules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace sparselens {
namespace {

constexpr std::ptrdiff_t stride = 68;
constexpr std::size_t first = std::size_t(stride) + 2; // of the 64 in the middle of three rows

TEST(CellRows, EmptyOnesAreThoseWhoseKeyIs0) {
    std::mt19937 random(3);
    std::vector<std::uint64_t> keys(64);
    for (auto &key : keys)
        key = random() % 3 == 0 ? 0 : kernels::key_of(kernels::background_upper, std::uint32_t(random()));
    const std::uint64_t zeros = zeros_of(keys.data());
    for (std::size_t n = 0; n < 64; ++n) EXPECT_EQ((zeros >> n & 1) != 0, keys[n] == 0) << n;
}

TEST(CellRows, DepthsAreThoseOfTheKeys) {
    std::vector<std::uint64_t> keys{0, kernels::key_of(kernels::background_upper, 7)};
    std::vector<float> expected{0, 0};
    for (float depth = 0; depth < 500; depth = 1.1f * depth + 0.01f) {
        keys.push_back(kernels::key_of(kernels::upper_of_depth(depth), std::uint32_t(keys.size())));
        expected.push_back(depth);
    }
    std::vector<float> depths(keys.size());
    depths_of(keys, depths.data());
    EXPECT_EQ(depths, expected);
}

TEST(CellRows, ACrackLiesWhereBothOfTwoOppositeOnesAreNearer) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> depth(0, 4 * kernels::behind_crack_px);
    std::vector<float> depths(3 * std::size_t(stride));
    std::ranges::generate(depths, [&] { return depth(random); });
    const std::uint64_t far = far_behind(&depths[first], stride);
    int found = 0;
    for (std::size_t n = 0; n < 64; ++n) {
        const auto is_nearer = [&](std::ptrdiff_t by) {
            return depths[std::size_t(std::ptrdiff_t(first + n) + by)] >
                   depths[first + n] + kernels::behind_crack_px;
        };
        bool expected = false;
        for (const std::ptrdiff_t by : {std::ptrdiff_t{1}, stride - 1, stride, stride + 1})
            expected = expected || (is_nearer(by) && is_nearer(-by));
        EXPECT_EQ((far >> n & 1) != 0, expected) << n;
        found += expected;
    }
    EXPECT_GT(found, 8);
    EXPECT_LT(found, 56);
}

} // namespace
} // namespace sparselens
