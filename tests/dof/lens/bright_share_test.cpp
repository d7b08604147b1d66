// The share of the surroundings that is as bright as a sample, compared with a count, and its effect on lamps.
#include "base/numbers.h"
#include "dof/lens/blocked_fixture.h"
#include "dof/lens/highlights.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {
namespace {

constexpr int size = 256;
const ThinLens lens{.radius = 2.4, .focal_px = 640, .focus = 5};

// All samples have CoC c; the first columns have brightness `bright`, the others are dark.
Ldi half_bright(double c, int columns, float bright) {
    return make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
        const float v = x < columns ? bright : 0.01f + 0.001f * float(random_unit(x, y, 1));
        return std::vector<Sample>{{depth_of(lens, c), {v, v, v, 1}}};
    });
}

std::uint32_t sample_at(const BlockedSamples &samples, int x, int y) {
    for (std::uint32_t i = 0; i < samples.count(); ++i)
        if (samples.x[i] == float(x) + 0.5f && samples.y[i] == float(y) + 0.5f) return i;
    return BlockedSamples::background;
}

// Boxes end at cells of 32 pixels: around x = 128 they would be from 96 to 160, except for half a pixel.
TEST(BrightShare, IsTheCountOfWhatIsHalfAsBright) {
    for (const int columns : {0, 96, 128, 160, 256}) {
        const Ldi ldi = half_bright(-64, columns, 3);
        const BlockedLdi blocked(ldi, lens);
        const auto brightness = [&](std::uint32_t i) { return blocked.colours.at(0, i); };
        const BrightShare share(ldi, blocked.samples, brightness);
        const double expected = std::clamp((columns - 96) / 64.0, 0.0, 1.0);
        const std::uint32_t i = sample_at(blocked.samples, 128, 128);
        for (const float as : {0.1f, 2.0f, 3.9f}) EXPECT_NEAR(share.around(i, as), expected, 0.5 / 64 + 1e-6);
        EXPECT_EQ(share.around(i, 16), 0);
        EXPECT_NEAR(share.around(i, 0.001f), 1, 1e-9);
    }
}

TEST(BrightShare, ChangesContinuouslyWithThePlaceAndTheBrightness) {
    const Ldi ldi = half_bright(20, 140, 3);
    const BlockedLdi blocked(ldi, lens);
    const BrightShare share(ldi, blocked.samples, [&](std::uint32_t i) { return blocked.colours.at(0, i); });
    for (int x = 60; x < 200; ++x) {
        const double here = share.around(sample_at(blocked.samples, x, 128), 3),
                     beside = share.around(sample_at(blocked.samples, x + 1, 128), 3);
        EXPECT_LE(beside, here + 1e-9) << x;
        EXPECT_GE(beside, here - 1.01 / 64) << x;
    }
    const std::uint32_t i = sample_at(blocked.samples, 120, 128);
    for (double brightness = 1; brightness < 20; brightness *= 1.01)
        EXPECT_NEAR(share.around(i, float(brightness)), share.around(i, float(1.01 * brightness)), 0.02);
}

// A strip of the bright surface is four times as bright as its dark neighbourhood, but is not a lamp, because lens
// points sample it well. A lamp in the dark is one, and so is a lamp on the surface.
TEST(TakeHighlights, TakesNoBrightSurfaceForALamp) {
    const auto taken = [](double c, float lamp) {
        Ldi ldi = half_bright(c, 140, 0.4f);
        for (const int x : {60, 200})
            for (std::size_t k = 0; k < 3 && lamp > 0; ++k) ldi.values[k][std::size_t(100 * size + x)] = lamp;
        BlockedLdi blocked(ldi, lens);
        const Highlights found = take_highlights(ldi, blocked.samples, blocked.colours);
        std::vector<float> x;
        for (const std::uint32_t i : found.sample) x.push_back(blocked.samples.x[i]);
        std::ranges::sort(x);
        return x;
    };
    for (const double c : {1.0, -20.0, 45.0, -90.0}) {
        EXPECT_EQ(taken(c, 0), std::vector<float>()) << c;
        EXPECT_EQ(taken(c, 60), (std::vector<float>{60.5f, 200.5f})) << c;
    }
}

} // namespace
} // namespace sparselens
