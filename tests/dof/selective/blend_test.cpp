#include "dof/selective/splats.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace sparselens {
namespace {

TEST(Blend, BinsFollowDepthAndStayFew) {
    EXPECT_EQ(depth_bin(0), 0);
    EXPECT_EQ(depth_bin(0.6), 1);
    EXPECT_EQ(depth_bin(-0.1), -1);
    int before = depth_bin(-1e4);
    for (double c = -1e4; c < 1e4; c += 0.25) {
        const int bin = depth_bin(c);
        ASSERT_GE(bin, before);
        ASSERT_LE(bin, before + 1) << "a bin is empty at " << c;
        before = bin;
    }
    EXPECT_LT(depth_bin(1e4) - depth_bin(-1e4), 1000);
    EXPECT_LT(depth_bin(1e30), 10000);
}

// The sums of a layer of one colour channel.
struct Layer {
    double coverage, known, colour;
};

double blend(const std::vector<Layer> &layers, double &colour) {
    std::vector<double> sums;
    for (const Layer &layer : layers) sums.insert(sums.end(), {layer.coverage, layer.known, layer.colour});
    return blend_layers(sums, {&colour, 1});
}

TEST(Blend, FrontCoversBack) {
    double colour = 0;
    EXPECT_DOUBLE_EQ(blend({{0.25, 0.25, 0.25 * 8}, {1, 1, 4}}, colour), 1);
    EXPECT_DOUBLE_EQ(colour, 0.25 * 8 + 0.75 * 4);
}

TEST(Blend, CoverageBeyondOneIsAMean) {
    double colour = 0;
    EXPECT_DOUBLE_EQ(blend({{1.5, 1.5, 3}, {1, 1, 100}}, colour), 1);
    EXPECT_DOUBLE_EQ(colour, 2);
}

TEST(Blend, LightThatPassesIsKnown) {
    // A veil of coverage 0.4, known everywhere, before a plane that is mostly unseen: the veil keeps its coverage.
    double colour = 0;
    EXPECT_DOUBLE_EQ(blend({{0.4, 1, 0.4}, {0.1, 0.1, 0.1 * 3}}, colour), 1);
    EXPECT_DOUBLE_EQ(colour, 0.4 * 1 + 0.6 * 3);
    EXPECT_DOUBLE_EQ(blend({{0.4, 1, 0.4}, {0, 0.1, 0}}, colour), 0.4);
    EXPECT_DOUBLE_EQ(colour, 0.4);
}

TEST(Blend, UnknownIsLeftOut) {
    // Half of the area behind the front layer is unseen; the seen half stands for all of it.
    double colour = 0;
    EXPECT_DOUBLE_EQ(blend({{0.5, 0.5, 0.5 * 6}, {0.25, 0.25, 0.25 * 2}, {0, 0.25, 0}}, colour),
                     0.5 + 0.5 * 0.5);
    EXPECT_DOUBLE_EQ(colour, 0.5 * 6 + 0.5 * 0.5 * 2);
}

TEST(Blend, NothingKnownIsTransparent) {
    double colour = 7;
    EXPECT_EQ(blend({}, colour), 0);
    EXPECT_EQ(colour, 0);
    EXPECT_EQ(blend({{0, 1, 0}}, colour), 0);
}

TEST(Blend, OpaqueIsExactlyOpaque) {
    double colour = 0;
    for (int i = 0; i < 1000; ++i) {
        std::vector<Layer> layers;
        for (int k = 0; k <= i % 5; ++k) {
            const double coverage = random_unit(i, k, 1) + 1e-9;
            layers.push_back({coverage, coverage, 1});
        }
        EXPECT_EQ(float(blend(layers, colour)), 1.0f);
    }
}

TEST(Blend, FrameShareIsWhatLiesInside) {
    const Imath::Box2i data({-10, 5}, {29, 24});
    EXPECT_EQ(window_share(data, 1, 5, 14, 9), 1);
    EXPECT_NEAR(window_share(data, 1, -10, 14, 1e-3), 1, 1e-12);
    EXPECT_NEAR(window_share(data, 1, 9, 14, 1e4), 40 * 20 / (std::numbers::pi * 1e8), 1e-12);
    // Half a pixel from a straight border: half the disc and a strip of nearly 0.5 x 2 r.
    EXPECT_NEAR(window_share(data, 1, -10, 14, 5), 0.5 + (0.5 * 2 * 5) / (std::numbers::pi * 25), 1e-3);
    EXPECT_NEAR(window_share(data, 2, 5, 5, 4), 0.5 + (0.5 * 2 * 4) / (std::numbers::pi * 32), 1e-3);
}

constexpr double bin_coverage = 0.3;

// Adds one bin at one pixel; its colour is its number.
void add(TileLayers &layers, int bin) {
    const std::array<double, 3> sums{bin_coverage, bin_coverage, bin_coverage * bin};
    layers.add(0, bin, sums.data(), 1, 1);
}

double colour_of(const std::vector<std::vector<int>> &expected_layers) {
    std::vector<Layer> layers;
    for (const auto &bins : expected_layers) {
        layers.push_back({0, 0, 0});
        for (const int bin : bins) {
            layers.back().coverage += bin_coverage;
            layers.back().known += bin_coverage;
            layers.back().colour += bin_coverage * bin;
        }
    }
    double colour = 0;
    blend(layers, colour);
    return colour;
}

double colour_of(const TileLayers &layers) {
    double colour = 0;
    layers.blend(0, {&colour, 1});
    return colour;
}

TEST(TileLayers, BinsWithoutAGapAreOneLayer) {
    TileLayers layers(1, 8, 1);
    for (const int bin : {-20, -19, -18, -10, 3, 4}) add(layers, bin);
    EXPECT_NEAR(colour_of(layers), colour_of({{-20, -19, -18}, {-10}, {3, 4}}), 1e-12);
    EXPECT_GT(std::abs(colour_of(layers) - colour_of({{-20, -19, -18, -10}, {3, 4}})), 0.1);
}

TEST(TileLayers, NarrowestGapsAreMerged) {
    const std::vector<int> bins{-20, -10, -7, 1, 7, 20, 22}; // gaps 10, 3, 8, 6, 13, 2
    const std::vector<std::vector<std::vector<int>>> expected{
        {{-20, -10, -7, 1, 7, 20, 22}},         {{-20, -10, -7, 1, 7}, {20, 22}},
        {{-20}, {-10, -7, 1, 7}, {20, 22}},     {{-20}, {-10, -7}, {1, 7}, {20, 22}},
        {{-20}, {-10, -7}, {1}, {7}, {20, 22}},
    };
    for (std::size_t limit = 1; limit <= expected.size(); ++limit) {
        TileLayers layers(1, limit, 1);
        for (const int bin : bins) add(layers, bin);
        EXPECT_NEAR(colour_of(layers), colour_of(expected[limit - 1]), 1e-12) << limit << " layers";
    }
}

TEST(TileLayers, PixelsAreApartAndClearForgets) {
    TileLayers layers(2, 2, 1);
    const std::array<double, 6> sums{0.5, 0, 1, 0, 1.5, 0};
    layers.add(1, 4, sums.data(), 2, 0.5);
    double colour = 0;
    EXPECT_EQ(layers.blend(0, {&colour, 1}), 0);
    EXPECT_DOUBLE_EQ(layers.blend(1, {&colour, 1}), 0.5);
    EXPECT_DOUBLE_EQ(colour, 1.5);
    layers.clear();
    EXPECT_EQ(layers.blend(1, {&colour, 1}), 0);
}

} // namespace
} // namespace sparselens
