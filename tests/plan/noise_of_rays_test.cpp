// The predicted noise of rays through the lens: closed forms, and its limits.
#include "base/light.h"
#include "plan/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace sparselens {
namespace {

constexpr ThinLens lens{.radius = 0.1, .focal_px = 400, .focus = 5}; // a CoC of 8 px at infinity
constexpr float far_away = std::numeric_limits<float>::infinity();

double noise_of(const std::function<float(int x, int y)> &value, float z, int rays, int across = 1,
                const ThinLens &of_lens = lens) {
    const Windows windows = windows_of_size(128, 96);
    Image image(windows, rgba_channels());
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x)
            for (std::size_t k = 0; k < 3; ++k) image.at(k, x, y) = value(x, y);
    return noise_of_rays(image, std::vector<float>(windows.pixels(), z), of_lens, across, rays);
}

// A fine checker of a and b: each ray meets one or the other, as a coin shows heads or tails.
TEST(NoiseOfRays, IsThatOfACoinOnACheckerOutOfFocus) {
    const double a = 0.2, b = 0.6, mean = (a + b) / 2;
    const double slope = (tone_mapped(mean + 1e-6) - tone_mapped(mean - 1e-6)) / 2e-6;
    const auto checker = [&](int x, int y) { return float((x + y) % 2 == 0 ? a : b); };
    for (const int rays : {5, 80})
        EXPECT_NEAR(noise_of(checker, far_away, rays) * rays / std::pow(slope * (b - a) / 2, 2), 1, 0.02);
}

TEST(NoiseOfRays, OneColourHasNone) {
    EXPECT_LT(noise_of([](int, int) { return 0.5f; }, far_away, 1), 1e-12);
    EXPECT_EQ(noise_of([](int, int) { return 0.0f; }, far_away, 1), 0);
    EXPECT_EQ(noise_of([](int, int) { return -1.0f; }, far_away, 1), 0);
}

// Large squares of two colours: only their edges are mixed, as widely as the CoC is large.
TEST(NoiseOfRays, GrowsWithTheCoc) {
    const auto squares = [](int x, int y) { return (x / 32 + y / 32) % 2 == 0 ? 0.2f : 0.6f; };
    const double in_focus = noise_of(squares, 5, 16), blurred = noise_of(squares, far_away, 16);
    EXPECT_GT(in_focus, 0); // a pixel has rays on both sides of an edge
    EXPECT_GT(blurred, 2 * in_focus);
    ThinLens wide = lens;
    wide.pixel_aspect = 2;
    EXPECT_GT(noise_of(squares, far_away, 16, 1, wide), 1.2 * blurred);
}

TEST(NoiseOfRays, ALampOfAnyBrightnessIsAtMostWhite) {
    const auto lamp = [](float brightness) {
        return noise_of([&](int x, int y) { return x == 60 && y == 40 ? brightness : 0.0f; }, far_away, 1);
    };
    EXPECT_LT(lamp(1e30f), 15.0 * 15 / (128 * 96)); // white within its disc
    EXPECT_GT(lamp(1e30f), 10.0 * 10 / (128 * 96));
    EXPECT_LT(lamp(1), lamp(1e30f));
}

TEST(NoiseOfRays, PixelsOfFineViewsAreAveraged) {
    const auto checker = [](int x, int y) { return (x / 3 + y / 3) % 2 == 0 ? 0.2f : 0.6f; };
    EXPECT_GT(noise_of(checker, 5, 16, 2), 1.1 * noise_of(checker, 5, 16, 1));
}

} // namespace
} // namespace sparselens
