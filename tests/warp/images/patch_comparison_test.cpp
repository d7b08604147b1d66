// Comparison of blocks of two views, checked pixel by pixel.
#include "base/numbers.h"
#include "support/views.h"
#include "warp/images/patch_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace sparselens {
namespace {

constexpr double focal_px = 100, scale = 24;

struct Pair {
    Pair()
        : windows(windows_of_size(90, 60)), own(picture(1)), other(picture(2)),
          own_samples(own, own.image.channels), other_samples(other, other.image.channels),
          own_mapping({0, 0}, focal_px, windows), other_mapping({0.24, 0.1}, focal_px, windows),
          centre({&own_samples, &own_mapping}, scale), view({&other_samples, &other_mapping}, scale) {}

    // Two surfaces.
    View picture(unsigned seed) const {
        View made = random_view(windows, {0, 0}, seed);
        std::ranges::fill(made.image.plane(find_channel(made.image.channels, "A")), 1.0f);
        for (std::size_t i = 0; i < made.z.size(); ++i) {
            const Imath::V2i p = windows.pixel(i);
            made.z[i] = (p.x / 23 + p.y / 17) % 3 != 0 ? 3.0f : 24.0f;
        }
        return made;
    }

    Windows windows;
    View own, other;
    ViewSamples own_samples, other_samples;
    ViewMapping own_mapping, other_mapping;
    MatchedView centre, view;
};

// The mean over the patch around p of the comparable pixels.
float slowly(const Pair &pair, const Imath::V2i &p, float surface, double depth) {
    double sum = 0;
    int count = 0;
    for (int y = p.y - 3; y <= p.y + 3; ++y)
        for (int x = p.x - 3; x <= p.x + 3; ++x) {
            if (!pair.centre.contains(Imath::V2i(x, y))) continue;
            const MatchedView::Pixel own = pair.centre.at(x, y);
            MatchedView::Pixel seen;
            if (!(std::abs(own[3] - surface) < 1) ||
                !pair.view.at(pair.other_mapping.in_view({x + 0.5, y + 0.5}, depth / scale), seen) ||
                !(std::abs(seen[3] - surface) < 1))
                continue;
            for (std::size_t k = 0; k < 3; ++k) sum += std::pow(double(own[k]) - double(seen[k]), 2);
            ++count;
        }
    return count >= 0.4 * 49 ? float(sum / count) : std::numeric_limits<float>::quiet_NaN();
}

// Includes blocks that leave the picture, or whose counterparts do.
TEST(PatchComparison, BlocksAreAsPixelByPixel) {
    const Pair pair;
    constexpr float surface = 8;
    int known = 0, unknown = 0;
    for (const Imath::Box2i &block : {Imath::Box2i({24, 16}, {31, 23}), Imath::Box2i({0, 0}, {7, 7}),
                                      Imath::Box2i({80, 56}, {84, 59}), Imath::Box2i({40, 30}, {40, 30}),
                                      Imath::Box2i({-8, -8}, {-1, -1}), Imath::Box2i({200, 8}, {207, 15})})
        for (const double depth : {-3.0, 0.0, 7.3, 8.0, 40.0}) {
            const Grid pixels(block);
            PatchComparison comparison(pair.centre, block, surface);
            std::vector<float> found(pixels.size()), each(pixels.size());
            comparison.at_depth(pair.view, depth, found);
            PatchComparison::Field depths;
            depths.fill(float(depth) + 2);
            comparison.at_depths(pair.view, depths, -2, each);
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const float expected = slowly(pair, pixels.pixel(i), surface, depth);
                ASSERT_EQ(std::isnan(found[i]), std::isnan(expected)) << pixels.pixel(i) << ' ' << depth;
                ASSERT_EQ(std::isnan(each[i]), std::isnan(expected)) << pixels.pixel(i) << ' ' << depth;
                ++(std::isnan(expected) ? unknown : known);
                if (std::isnan(expected)) continue;
                ASSERT_NEAR(found[i], expected, 1e-4f * expected) << pixels.pixel(i) << ' ' << depth;
                ASSERT_NEAR(each[i], expected, 1e-4f * expected) << pixels.pixel(i) << ' ' << depth;
            }
        }
    EXPECT_GT(known, 200);
    EXPECT_GT(unknown, 200);
}

float mean_of(const std::vector<float> &differences) { return robust_means(differences, 1)[0]; }

TEST(RobustMeans, AreOfTheBestThreeQuarters) {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(mean_of({4.0f, 1.0f, 3.0f, 2.0f}), 2);
    EXPECT_EQ(mean_of({4.0f, none, 3.0f, 2.0f}), 3);
    EXPECT_EQ(mean_of({none, none, 3.0f, 2.0f}), 2.5f);
    EXPECT_TRUE(std::isnan(mean_of({none, none, 3.0f, none})));
    EXPECT_EQ(mean_of({5.0f}), 5);
    EXPECT_TRUE(std::isnan(mean_of({none})));
}

TEST(RobustMeans, OfPixelsAreThoseOfEach) {
    const std::vector<float> views{4, 5, 1, 6, 3, 7, 2, 9}; // for two pixels, view by view
    EXPECT_EQ(robust_means(views, 2), (std::vector{mean_of({4, 1, 3, 2}), mean_of({5, 6, 7, 9})}));
}

} // namespace
} // namespace sparselens
