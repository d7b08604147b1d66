#include "deep/flatten.h"
#include "deep/ldi.h"
#include "support/composite.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

namespace sparselens {
namespace {

float flattened(const TestPixel &pixel, std::size_t channel = 0) {
    return flatten(ldi_of({pixel})).plane(channel)[0];
}

TEST(Flatten, KeepsWindowsAndChannels) {
    Ldi ldi = random_ldi({});
    ldi.windows.display.max += Imath::V2i(100, 100);
    const Image picture = flatten(ldi);
    EXPECT_EQ(picture.windows, ldi.windows);
    EXPECT_EQ(picture.channels, ldi.channels);
}

TEST(Flatten, EmptyPixelsAreTransparentBlack) {
    for (std::size_t channel = 0; channel < 4; ++channel) EXPECT_EQ(flattened({}, channel), 0);
}

TEST(Flatten, TheOpaqueHidesWhatIsBehindBitForBit) {
    const TestPixel pixel{{.z = 1, .colour = 0.1f},
                          {.z = 2, .colour = std::numeric_limits<float>::infinity()}};
    EXPECT_EQ(flattened(pixel), 0.1f);
    EXPECT_EQ(flattened(pixel, 3), 1);
}

TEST(Flatten, IsOverFrontToBack) {
    const TestPixel pixel{
        {.z = 1, .colour = 0.5f, .alpha = 0.5f}, {.z = 2, .colour = 0.25f, .alpha = 0.75f}, {.z = 3}};
    EXPECT_FLOAT_EQ(flattened(pixel), 0.5f + 0.5f * 0.25f + 0.125f);
    EXPECT_FLOAT_EQ(flattened(pixel, 1), 0.5f * flattened(pixel));
    EXPECT_FLOAT_EQ(flattened(pixel, 3), 1);
}

TEST(Flatten, LightWithoutCoverageAdds) {
    EXPECT_EQ(flattened({{.z = 1, .colour = 3, .alpha = 0}, {.z = 2, .colour = 4}}), 7);
}

TEST(Flatten, AgreesWithASlowComposite) {
    const Ldi ldi = random_ldi({.width = 32, .height = 32, .most_samples = 50, .opaque_share = 0.02});
    const Image picture = flatten(ldi);
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
        const Composite seen = composite_in_order(samples_of(ldi, pixel));
        ASSERT_FLOAT_EQ(picture.plane(0)[pixel], float(seen.colour));
        ASSERT_FLOAT_EQ(picture.plane(3)[pixel], float(seen.alpha));
    }
}

TEST(Flatten, TenThousandThinSamplesAddUp) {
    TestPixel fog;
    for (int i = 0; i < 10'000; ++i) fog.push_back({.z = 1 + float(i), .colour = 1e-4f, .alpha = 1e-4f});
    EXPECT_FLOAT_EQ(flattened(fog), float(composite_in_order(fog).colour));
    EXPECT_NEAR(flattened(fog), 1 - std::exp(-1.00005), 1e-6);
}

TEST(Flatten, IdsAreThoseOfTheFront) {
    Ldi ldi = ldi_of({{{.z = 1, .alpha = 0.5f}, {.z = 2}}, {}, {{.z = 3}}});
    ldi.channels.push_back({"id", PixelType::uint32});
    const float odd = std::bit_cast<float>(0xff800001u); // a NaN if read as a number
    ldi.values.push_back({odd, 7, 8});
    const Image picture = flatten(ldi);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(picture.plane(4)[0]), 0xff800001u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(picture.plane(4)[1]), 0u);
    EXPECT_EQ(picture.plane(4)[2], 8);
}

// Each light alone is below the resolution of a float near 1; their sum is not.
TEST(Flatten, ThousandsOfFaintLightsAddUp) {
    TestPixel pixel{{.z = 1, .colour = 1, .alpha = 0}};
    for (int i = 0; i < 4096; ++i) pixel.push_back({.z = float(2 + i), .colour = 3e-8f, .alpha = 0});
    EXPECT_NEAR(flatten(ldi_of({pixel})).values[0], 1 + 4096 * 3e-8, 1e-7);
}

} // namespace
} // namespace sparselens
