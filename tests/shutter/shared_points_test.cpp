#include "lens/aperture.h"
#include "shutter/shutter_mean.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace sparselens {
namespace {

constexpr std::size_t counts[] = {1, 7, 96, 100, 256, 896};
constexpr int moments[] = {2, 3, 4, 5, 8, 16};

auto all_of(const LensSample &s) { return std::tuple(s.x, s.y, s.pixel_x, s.pixel_y, s.weight); }

std::vector<std::vector<LensSample>> shares_of(const std::vector<LensSample> &points, int count) {
    std::vector<std::vector<LensSample>> shares;
    for (int m = 0; m < count; ++m) shares.push_back(shared_points(points, {m, count}));
    return shares;
}

TEST(SharedPoints, OfOneMomentAreAll) {
    const auto points = disc_lens_samples(96, 1), same = shared_points(points, {0, 1});
    EXPECT_TRUE(std::ranges::equal(points, same, {}, all_of, all_of));
}

TEST(SharedPoints, OfAllMomentsAreThePointsOfAStill) {
    for (const std::size_t n : counts)
        for (const int count : moments) {
            const auto points = disc_lens_samples(n, 1);
            std::vector<LensSample> together;
            for (const auto &share : shares_of(points, count)) {
                EXPECT_GE(share.size(), std::max<std::size_t>(n / std::size_t(count), 1));
                EXPECT_LE(share.size(), n / std::size_t(count) + 1);
                together.insert(together.end(), share.begin(), share.end());
            }
            if (n < std::size_t(count)) continue; // several moments then take one point
            const auto by_values = [](const LensSample &a, const LensSample &b) {
                return all_of(a) < all_of(b);
            };
            auto sorted = points;
            std::ranges::sort(sorted, by_values);
            std::ranges::sort(together, by_values);
            EXPECT_TRUE(std::ranges::equal(sorted, together, {}, all_of, all_of)) << n << ' ' << count;
        }
}

// The mean square error of the share of points on one side of a line, over many lines. It is p (1 - p) / n for random
// points.
struct HalfPlanes {
    double error = 0, random = 0;
};
HalfPlanes half_planes(const std::vector<LensSample> &points) {
    HalfPlanes all;
    const auto n = double(points.size());
    for (int k = 0; k < 24; ++k)
        for (const double distance : {-0.6, -0.3, 0.0, 0.3, 0.6}) {
            const double angle = k * std::numbers::pi / 12, x = std::cos(angle), y = std::sin(angle);
            const auto beyond = std::ranges::count_if(
                points, [&](const LensSample &s) { return x * double(s.x) + y * double(s.y) > distance; });
            const double share =
                (std::acos(distance) - distance * std::sqrt(1 - distance * distance)) / std::numbers::pi;
            all.error += std::pow(double(beyond) / n - share, 2);
            all.random += share * (1 - share) / n;
        }
    return all;
}

// Each share has at most half of the error of random points: picked by their number in the set, every eighth point lies in
// nearly one direction, which is worse than random.
TEST(SharedPoints, AreSpreadOverTheLens) {
    for (const std::size_t n : {96u, 128u, 256u, 896u})
        for (const int count : moments) {
            HalfPlanes all;
            for (const auto &share : shares_of(disc_lens_samples(n, 1), count)) {
                const HalfPlanes one = half_planes(share);
                all.error += one.error;
                all.random += one.random;
            }
            EXPECT_LT(all.error, all.random / 2) << n << ' ' << count;
        }
}

TEST(SharedPoints, AreSpreadOverThePixel) {
    for (const int count : {2, 4, 8})
        for (const auto &share : shares_of(disc_lens_samples(256, 1), count)) {
            double x = 0, y = 0;
            for (const LensSample &s : share) x += double(s.pixel_x), y += double(s.pixel_y);
            const auto n = double(share.size());
            const double of_random = std::sqrt(1.0 / 12 / n); // standard deviation of the mean
            EXPECT_LT(std::abs(x / n), 2 * of_random) << count;
            EXPECT_LT(std::abs(y / n), 2 * of_random) << count;
        }
}

// All look through the same place of the lens. In the pixel, whose borders meet, the third point lies nearer to the first
// than to the second, so it goes to the moment of the second.
TEST(SharedPoints, OfOnePlaceOfTheLensLieApartInThePixel) {
    for (const auto at : {&LensSample::pixel_x, &LensSample::pixel_y}) {
        std::vector<LensSample> points(4);
        points[0].*at = -0.45f;
        points[1].*at = 0.1f;
        points[2].*at = 0.45f;
        const std::vector<LensSample> share = shared_points(points, {1, 2});
        ASSERT_EQ(share.size(), 2u);
        EXPECT_EQ(share[0].*at, 0.1f);
        EXPECT_EQ(share[1].*at, 0.45f);
    }
}

TEST(SharedPoints, KeepTheirWeights) {
    const Aperture ring({.blades = 6, .spherical = 0.5});
    float sum = 0;
    for (const auto &share : shares_of(lens_samples(ring, 96, 1), 4))
        for (const LensSample &s : share) sum += s.behind[1];
    float still = 0;
    for (const LensSample &s : lens_samples(ring, 96, 1)) still += s.behind[1];
    EXPECT_NEAR(sum, still, 1e-3f);
}

} // namespace
} // namespace sparselens
