#include "match/smooth_keys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace sparselens {
namespace {

// The values have a deviation of 1 and are independent.
double noise(int i) {
    std::mt19937 random{std::uint32_t(i)};
    return 3.4641 * (double(random()) / 4294967295.0 - 0.5);
}

std::vector<KeyedValue> ramp(int count, double deviation) {
    std::vector<KeyedValue> keys;
    for (int i = 0; i < count; ++i) keys.push_back({2 + 0.3 * i + deviation * noise(i), deviation});
    return keys;
}

TEST(SmoothKeys, a_ramp_stays_and_its_noise_falls) {
    const std::vector<KeyedValue> keys = ramp(48, 0.1), smooth = smooth_keys(keys);
    double before = 0, after = 0;
    for (int i = 0; i < 48; ++i) {
        before += std::pow(keys[std::size_t(i)].value - (2 + 0.3 * i), 2);
        after += std::pow(smooth[std::size_t(i)].value - (2 + 0.3 * i), 2);
        EXPECT_LT(smooth[std::size_t(i)].deviation, 0.1);
    }
    EXPECT_LT(after, 0.2 * before);
}

TEST(SmoothKeys, a_move_that_is_larger_than_the_noise_is_followed) {
    std::vector<KeyedValue> keys;
    for (int i = 0; i < 48; ++i) keys.push_back({std::tanh((i - 24) / 4.0), 0.01});
    const std::vector<KeyedValue> smooth = smooth_keys(keys);
    for (std::size_t i = 0; i < keys.size(); ++i) EXPECT_NEAR(smooth[i].value, keys[i].value, 0.03);
}

// Deviations are too large where they contain an error that all frames share.
TEST(SmoothKeys, a_move_is_followed_also_if_the_deviations_are_too_large) {
    std::vector<KeyedValue> keys;
    for (int i = 0; i < 48; ++i) keys.push_back({std::tanh((i - 24) / 8.0) + 0.01 * noise(i), 0.2});
    const std::vector<KeyedValue> smooth = smooth_keys(keys);
    for (int i = 0; i < 48; ++i) {
        EXPECT_NEAR(smooth[std::size_t(i)].value, std::tanh((i - 24) / 8.0), 0.02);
        EXPECT_LT(smooth[std::size_t(i)].deviation, 0.1);
    }
}

TEST(SmoothKeys, deviations_grow_where_values_differ_by_more) {
    std::vector<KeyedValue> keys = ramp(48, 0.1);
    for (KeyedValue &key : keys) key.deviation = 0.01;
    EXPECT_GT(smooth_keys(keys)[24].deviation, 0.012);
}

TEST(SmoothKeys, a_few_values_keep_their_deviations) {
    const std::vector<KeyedValue> smooth =
        smooth_keys(std::vector<KeyedValue>{{1, 0.1}, {1.001, 0.1}, {1.002, 0.1}});
    EXPECT_NEAR(smooth[1].deviation, 0.1 / std::sqrt(3.0), 0.03);
}

TEST(SmoothKeys, an_unknown_value_lies_between_its_neighbours_and_an_outlier_hardly_counts) {
    std::vector<KeyedValue> keys = ramp(20, 0.01);
    keys[5] = {0, std::numeric_limits<double>::infinity()};
    keys[12].value += 5;
    const std::vector<KeyedValue> smooth = smooth_keys(keys);
    EXPECT_NEAR(smooth[5].value, 2 + 0.3 * 5, 0.03);
    EXPECT_NEAR(smooth[12].value, 2 + 0.3 * 12, 0.05);
    EXPECT_NEAR(smooth_keys(std::vector<KeyedValue>{{3, 0.1}})[0].value, 3, 1e-6);
}

} // namespace
} // namespace sparselens
