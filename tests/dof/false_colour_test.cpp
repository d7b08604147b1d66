#include "base/progress.h"
#include "dof/false_colour.h"
#include "dof/lens/lens_gather.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.1, .focal_px = 200, .focus = 5}; // c(inf) = 4

Imath::V3f colour_at(const Image &image, int x, int y) {
    EXPECT_EQ(image.at(3, x, y), 1);
    return {image.at(0, x, y), image.at(1, x, y), image.at(2, x, y)};
}

// One row; pixel x has samples of brightness 1 at these depths.
Ldi row(const std::vector<std::vector<double>> &depths) {
    return make_ldi(windows_of_size(int(depths.size()), 1), rgba_channels(), [&](int x, int) {
        std::vector<Sample> samples;
        for (const double z : depths[std::size_t(x)]) samples.push_back({z, {1, 1, 1, 1}});
        return samples;
    });
}

TEST(FalseColour, CocIsBlueInFrontAndRedBehind) {
    const double inf = std::numeric_limits<double>::infinity();
    const Image image =
        coc_colours(row({{5}, {depth_of(lens, -8), 5}, {depth_of(lens, 2)}, {inf}, {}}), lens);
    const auto near = [](const Imath::V3f &a, const Imath::V3f &b) { return a.equalWithAbsError(b, 1e-5f); };
    EXPECT_TRUE(near(colour_at(image, 0, 0), {1, 1, 1}));
    EXPECT_TRUE(near(colour_at(image, 1, 0), {0.5f, 0.5f, 1}));
    EXPECT_TRUE(near(colour_at(image, 2, 0), {1, 0.8f, 0.8f})); // 2 / (2 + 8)
    EXPECT_TRUE(near(colour_at(image, 3, 0), {1, 8 / 12.0f, 8 / 12.0f}));
    EXPECT_EQ(colour_at(image, 4, 0), colour_at(image, 3, 0)); // empty: sky
}

TEST(FalseColour, FocusIsGreenWhereTheCocIsUnderAPixel) {
    const Image image = focus_colours(row({{depth_of(lens, 0.9)}, {depth_of(lens, -1.1)}, {}}), lens);
    EXPECT_EQ(colour_at(image, 0, 0),
              Imath::V3f(0.25f, 0.75f, 0.25f)); // brightness 1 is tone-mapped to a half
    EXPECT_EQ(colour_at(image, 1, 0), Imath::V3f(0.25f, 0.25f, 0.25f));
    EXPECT_EQ(colour_at(image, 2, 0), Imath::V3f(0, 0, 0));
}

TEST(FalseColour, LayersAreCounted) {
    const std::vector<double> depths{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    std::vector<std::vector<double>> pixels;
    for (std::size_t n = 0; n <= 10; ++n)
        pixels.emplace_back(depths.begin(), depths.begin() + std::ptrdiff_t(n));
    const Image image = layer_colours(row(pixels));
    EXPECT_EQ(colour_at(image, 0, 0), Imath::V3f(0, 0, 0));
    EXPECT_EQ(colour_at(image, 2, 0), Imath::V3f(0, 0, 1));
    EXPECT_EQ(colour_at(image, 4, 0), Imath::V3f(0, 1, 0));
    EXPECT_EQ(colour_at(image, 10, 0), Imath::V3f(1, 1, 1));
    for (int n = 0; n < 8; ++n) EXPECT_NE(colour_at(image, n, 0), colour_at(image, n + 1, 0)) << n;
}

TEST(FalseColour, TilesShowTheirLensPoints) {
    const LensTiles tiles{.size = 2, .columns = 3, .rows = 2, .lens_points = {0, 16, 256, 4096, 0, 64}};
    Windows windows = windows_of_size(5, 3); // the last column and row are partial blocks
    windows.data = {{10, -3}, {14, -1}};
    const Image image = tile_colours(tiles, windows);
    EXPECT_EQ(colour_at(image, 10, -3), Imath::V3f(0, 0, 0));
    EXPECT_EQ(colour_at(image, 13, -2), Imath::V3f(0, 0, 1));
    EXPECT_EQ(colour_at(image, 14, -2), Imath::V3f(0, 1, 0));
    EXPECT_EQ(colour_at(image, 11, -1), Imath::V3f(1, 0, 0));
    EXPECT_EQ(colour_at(image, 14, -1), Imath::V3f(0, 0.5f, 0.5f));
    EXPECT_EQ(histogram(tiles), (std::map<int, int>{{0, 2}, {16, 1}, {64, 1}, {256, 1}, {4096, 1}}));
}

// The number of lens points that the gather reports: nothing for tiles in focus, which are copied; the requested number
// elsewhere.
TEST(LensTiles, SayWhatTheGatherChose) {
    const Windows windows = windows_of_size(200, 70); // 4 x 2 tiles
    const Ldi ldi = make_ldi(windows, rgba_channels(), [&](int x, int) {
        return std::vector<Sample>{{depth_of(lens, x < 100 ? 0 : 3), {1, 1, 1, 1}}};
    });
    LensTiles chosen;
    Progress silent;
    lens_gather(ldi, lens, windows.data, {.lens_samples = 40, .chosen = &chosen}, silent);
    EXPECT_EQ(chosen.columns, 4);
    EXPECT_EQ(chosen.rows, 2);
    EXPECT_EQ(chosen.lens_points, (std::vector<int>{0, 40, 40, 40, 0, 40, 40, 40}));
}

} // namespace
} // namespace sparselens
