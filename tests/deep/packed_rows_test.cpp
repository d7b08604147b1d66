#include "deep/packed_rows.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace sparselens {
namespace {

// Halves, with a float that is not a half every `step` values.
std::vector<float> values_with_others(std::size_t count, std::size_t step) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = i % step == 1 ? 0.1f * float(i) : 0.25f * float(i % 2000);
    return values;
}

void expect_same_bits(const std::vector<float> &packed, const std::vector<float> &as_they_were) {
    ASSERT_EQ(packed.size(), as_they_were.size());
    for (std::size_t i = 0; i < packed.size(); ++i)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(packed[i]), std::bit_cast<std::uint32_t>(as_they_were[i]))
            << i;
}

std::vector<float> unpacked(const PackedFloats &packed, std::size_t from, std::size_t count) {
    std::vector<float> values(count);
    packed.unpack(from, values);
    return values;
}

TEST(PackedFloats, ValuesComeBackAsTheyWere) {
    for (const std::size_t step : {1000u, 100u, 5u, 4u, 3u, 2u}) {
        const std::vector<float> values = values_with_others(1000, step);
        const PackedFloats packed(values);
        expect_same_bits(unpacked(packed, 0, 1000), values);
        expect_same_bits(unpacked(packed, 101, 57), {values.begin() + 101, values.begin() + 158});
    }
}

TEST(PackedFloats, SpecialValuesComeBackAsTheyWere) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> values{0,
                                    -0.0f,
                                    inf,
                                    -inf,
                                    std::nanf(""),
                                    std::nanf("17"),
                                    65504,
                                    65505,
                                    1e38f,
                                    6e-8f,
                                    5.9e-8f,
                                    1e-40f,
                                    -1,
                                    3,
                                    4,
                                    5,
                                    6,
                                    7,
                                    8,
                                    9,
                                    10,
                                    11,
                                    12,
                                    13};
    expect_same_bits(unpacked(PackedFloats(values), 0, values.size()), values);
    EXPECT_EQ(PackedFloats(std::vector<float>{}).bytes(), 0u);
}

TEST(PackedFloats, ValuesThatAreOneButForAFewTakeNextToNothing) {
    for (const float most : {1.0f, 0.1f}) { // a half, and not a half
        std::vector<float> values(1000, most);
        for (const std::size_t i : {0u, 1u, 2u, 500u, 999u}) values[i] = float(i) + 0.3f;
        const PackedFloats packed(values);
        EXPECT_EQ(packed.bytes(), 5 * 8u);
        expect_same_bits(unpacked(packed, 0, 1000), values);
        expect_same_bits(unpacked(packed, 400, 200), {values.begin() + 400, values.begin() + 600});
    }
}

TEST(PackedFloats, HalvesTakeTwoBytesAndNothingTakesMoreThanFour) {
    EXPECT_EQ(PackedFloats(values_with_others(1000, 100'000)).bytes(), 2000u + 8);
    for (const std::size_t step : {100u, 5u, 4u, 3u, 2u})
        EXPECT_LE(PackedFloats(values_with_others(1000, step)).bytes(), 4000u) << step;
}

class PackedPicture : public testing::Test {
protected:
    static constexpr int height = 50;
    Ldi ldi = random_ldi({.seed = 7, .width = 9, .height = height, .opaque_share = 0.3, .volume_share = 0.2});

    // Some rows of the LDI, copied in the simple way.
    Ldi slow_rows(int first, int last) const {
        Ldi rows;
        rows.windows = ldi.windows;
        rows.windows.data.min.y = first;
        rows.windows.data.max.y = last;
        rows.channels = ldi.channels;
        rows.values.resize(ldi.values.size());
        rows.begin = {0};
        for (int y = first; y <= last; ++y)
            for (int x = 0; x < 9; ++x) {
                for (const std::uint64_t i : ldi.pixel(ldi.windows.index(Imath::V2i(x, y)))) {
                    const auto from = arrays_of(std::as_const(ldi));
                    const auto to = arrays_of(rows);
                    for (std::size_t k = 0; k < to.size(); ++k)
                        if (!from[k]->empty()) to[k]->push_back((*from[k])[i]);
                }
                rows.begin.push_back(rows.z.size());
            }
        return rows;
    }
    PackedRows packed_by(int rows_at_once) const {
        PackedRows packed(ldi.windows);
        for (int y = 0; y < height; y += rows_at_once)
            packed.append(slow_rows(y, std::min(y + rows_at_once, height) - 1));
        return packed;
    }
    static void expect_same(const Ldi &a, const Ldi &b) {
        EXPECT_EQ(a.windows, b.windows);
        EXPECT_EQ(a.channels, b.channels);
        EXPECT_EQ(a.begin, b.begin);
        EXPECT_EQ(a.z, b.z);
        EXPECT_EQ(a.z_back, b.z_back);
        EXPECT_EQ(a.dx, b.dx);
        EXPECT_EQ(a.dy, b.dy);
        EXPECT_EQ(a.weight, b.weight);
        EXPECT_EQ(a.image_z, b.image_z);
        EXPECT_EQ(a.solid, b.solid);
        EXPECT_EQ(a.values, b.values);
    }
};

TEST_F(PackedPicture, AnyRowsAreThoseOfThePicture) {
    for (const int at_once : {1, 7, 16, height}) {
        const PackedRows packed = packed_by(at_once);
        EXPECT_EQ(packed.samples(), ldi.samples());
        expect_same(packed.rows(0, height - 1), ldi);
        for (const auto &[first, last] : {std::pair(0, 0), {3, 20}, {16, 31}, {31, height - 1}, {49, 49}}) {
            expect_same(packed.rows(first, last), slow_rows(first, last));
            EXPECT_EQ(packed.samples(first, last), slow_rows(first, last).samples());
        }
    }
}

TEST_F(PackedPicture, PixelsAboveHaveNoSamples) {
    const Ldi rows = with_empty_above(slow_rows(20, 30), 5);
    EXPECT_EQ(rows.windows.data, Imath::Box2i({0, 5}, {8, 30}));
    ASSERT_EQ(rows.begin.size(), rows.windows.pixels() + 1);
    EXPECT_EQ(rows.begin[rows.windows.index(Imath::V2i(8, 19)) + 1], 0u);
    EXPECT_EQ(rows.pixel(rows.windows.index(Imath::V2i(4, 25))).size(),
              ldi.pixel(ldi.windows.index(Imath::V2i(4, 25))).size());
}

TEST_F(PackedPicture, ChannelsThatAreNotKeptAreForgotten) {
    PackedRows packed = packed_by(16);
    const std::vector<Channel> kept{ldi.channels[3], ldi.channels[1]};
    const std::size_t before = packed.bytes();
    packed.keep_channels(kept);
    EXPECT_LT(packed.bytes(), before);
    const Ldi rows = packed.rows(10, 40), whole = slow_rows(10, 40);
    EXPECT_EQ(rows.channels, kept);
    EXPECT_EQ(rows.z, whole.z);
    EXPECT_EQ(rows.values, (std::vector<std::vector<float>>{whole.values[3], whole.values[1]}));
}

} // namespace
} // namespace sparselens
