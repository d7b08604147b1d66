#include "base/image.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sparselens {
namespace {

void expect_same_bits(const Plane &plane, const std::vector<float> &values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(plane[i]), std::bit_cast<std::uint32_t>(values[i])) << i;
    if (values.empty()) return;
    std::vector<float> copied(values.size() - 1);
    plane.copy(1, copied);
    for (std::size_t i = 0; i < copied.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(copied[i]), std::bit_cast<std::uint32_t>(values[i + 1])) << i;
}

void expect_packed(const std::vector<float> &values, std::size_t bytes) {
    const Plane plane = Plane::packed(values);
    expect_same_bits(plane, values);
    EXPECT_EQ(plane.bytes(), bytes);
    const Plane seen = Plane::of(values);
    expect_same_bits(seen, values);
    EXPECT_EQ(seen.bytes(), 0u);
}

TEST(Plane, AllHalvesTakeTwoBytes) {
    std::vector<float> all; // a NaN may change on its way through a float
    for (std::uint32_t bits = 0; bits < 0x10000; ++bits)
        if (const float value = of_half(std::uint16_t(bits)); !std::isnan(value)) all.push_back(value);
    expect_packed(all, 2 * all.size());
}

TEST(Plane, WhatIsTheSameEverywhereTakesOneValue) {
    expect_packed(std::vector<float>(10'000, 1), 4);
    expect_packed(std::vector<float>(10'000, 0.1f), 4);
    expect_packed({-0.0f, 0.0f}, 4); // two halves
}

// One value among many that a half cannot hold: too many bits, too large, too small, an id.
TEST(Plane, OtherFloatsStay) {
    for (const float other : {0.1f, 65520.0f, 1e-9f, 1e-5f, std::bit_cast<float>(12345u),
                              std::numeric_limits<float>::max(), std::numeric_limits<float>::denorm_min()})
        for (const std::size_t place : {0u, 4095u, 4096u, 9999u}) {
            std::vector<float> values(10'000);
            for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i % 100) / 8;
            values[place] = other;
            expect_packed(values, 4 * values.size());
        }
}

TEST(Plane, MayHaveNoValue) { expect_packed({}, 0); }

} // namespace
} // namespace sparselens
