#include "base/subpixels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace sparselens {
namespace {

using Shape = PixelFilter::Shape;

TEST(PixelFilter, IsReadAndWritten) {
    EXPECT_EQ(pixel_filter_of("box"), PixelFilter{});
    EXPECT_EQ(pixel_filter_of("gaussian"), (PixelFilter{Shape::gaussian, 1.5}));
    EXPECT_EQ(pixel_filter_of("blackman-harris:2.25"), (PixelFilter{Shape::blackman_harris, 2.25}));
    for (const char *wrong : {"", "Box", "box:1", "gaussian:", "gaussian:0", "gaussian:-1", "gaussian:17",
                              "gaussian:nan", "gaussian:1x", "mitchell", "gaussian:1:2"})
        EXPECT_FALSE(pixel_filter_of(wrong)) << wrong;
    for (const char *text : {"box", "gaussian:1.5", "blackman-harris:0.5"})
        EXPECT_EQ(text_of(pixel_filter_of(text).value()), text);
}

// The variance in square sub-pixels of shares one sub-pixel apart.
double variance_of(const std::vector<double> &shares) {
    double sum = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double at = double(i) - (double(shares.size()) - 1) / 2;
        sum += shares[i] * at * at;
    }
    return sum;
}

// The variance of the Blackman-Harris window over the width 1, summed numerically.
double blackman_harris_variance() {
    const double turn = 2 * std::numbers::pi;
    double all = 0, square = 0;
    constexpr int steps = 100000;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps, x = t - 0.5;
        const double w = 0.35875 - 0.48829 * std::cos(turn * t) + 0.14128 * std::cos(2 * turn * t) -
                         0.01168 * std::cos(3 * turn * t);
        all += w;
        square += w * x * x;
    }
    return square / all;
}

TEST(SubpixelShares, AddUpAreSymmetricAndNeverNegative) {
    for (const Shape shape : {Shape::box, Shape::blackman_harris, Shape::gaussian})
        for (int across = 1; across <= most_across; ++across)
            for (const double width : {0.1, 1.5, 4.0}) {
                const std::vector<double> shares = subpixel_shares({across, {shape, width}});
                EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-12);
                EXPECT_EQ((shares.size() - std::size_t(across)) % 2, 0u);
                for (std::size_t i = 0; i < shares.size(); ++i) {
                    EXPECT_GE(shares[i], 0);
                    EXPECT_NEAR(shares[i], shares[shares.size() - 1 - i], 1e-15);
                }
            }
}

// A box is as wide as the block. So is any narrower filter, and any filter with one sub-pixel.
TEST(SubpixelShares, OfABoxAreEqual) {
    for (const PixelFilter &filter : {PixelFilter{}, PixelFilter{Shape::gaussian, 0.5}})
        EXPECT_EQ(subpixel_shares({4, filter}), std::vector<double>(4, 0.25));
    EXPECT_EQ(subpixel_shares({1, {Shape::gaussian, 8}}), std::vector<double>(1, 1.0));
}

// Together with the variance of the views and of the gather, the variance is the filter's.
TEST(SubpixelShares, HaveTheVarianceThatIsMissing) {
    for (int across = 2; across <= 8; ++across)
        for (const double width : {1.5, 2.0, 3.0}) {
            const double more = double(across) * across - 1, of_gather = 0.125;
            const double gaussian = width * width / 16,
                         blackman_harris = blackman_harris_variance() * (2 * width) * (2 * width);
            EXPECT_NEAR(variance_of(subpixel_shares({across, {Shape::blackman_harris, width}})),
                        blackman_harris * more - of_gather, 1e-3 * blackman_harris * more);
            EXPECT_NEAR(variance_of(subpixel_shares({across, {Shape::gaussian, width}})),
                        gaussian * more - of_gather, 1e-9);
        }
}

// The values tuned by hand for Cycles' default filter: .075, .85, .075 before the mean of two.
TEST(SubpixelShares, OfCyclesAtTwiceTheSize) {
    const std::vector<double> shares = subpixel_shares({2, {Shape::blackman_harris, 1.5}});
    ASSERT_EQ(shares.size(), 4u);
    EXPECT_NEAR(2 * shares[0], 0.075, 0.005);
    EXPECT_NEAR(2 * shares[1], 0.925, 0.005);
}

} // namespace
} // namespace sparselens
