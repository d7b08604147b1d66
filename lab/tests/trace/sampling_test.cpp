#include "lab/trace/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace sparselens::lab {
namespace {

// In every dimension, each of 2^k equal intervals holds one of 2^k points, with any scrambling.
TEST(Sampling, EveryCoordinateIsStratified) {
    const SobolPoints points(256);
    for (std::size_t dimension = 0; dimension < SobolPoints::dimensions; ++dimension)
        for (const std::uint32_t seed : {0u, 1u, 0xdeadbeefu})
            for (const std::size_t n : {1u, 4u, 16u, 256u}) {
                std::vector<double> x(n);
                points.coordinates(dimension, seed, 0, x);
                std::set<int> intervals;
                for (const double v : x) {
                    EXPECT_GE(v, 0);
                    EXPECT_LT(v, 1);
                    intervals.insert(int(v * double(n)));
                }
                EXPECT_EQ(intervals.size(), n) << dimension;
            }
}

// The lens pair is a (0, 8, 2)-net: one point in each elementary interval of area 1/256, of any shape.
TEST(Sampling, LensPairIsANet) {
    const PixelSamples samples(256, false, 3);
    std::vector<Imath::V2d> p(256);
    samples.on_lens(-7, 12, 0, p);
    for (int k = 0; k <= 8; ++k) {
        std::set<int> cells;
        for (const Imath::V2d &v : p) cells.insert(int(v.x * (1 << k)) * 256 + int(v.y * (256 >> k)));
        EXPECT_EQ(cells.size(), 256u) << k;
    }
}

// Each eighth of the shutter's time has points in all quarters of the lens, as evenly as their number allows.
TEST(Sampling, TimesAndLensPointsAreSpreadTogether) {
    const PixelSamples samples(256, false, 3);
    std::vector<Imath::V2d> lens(256);
    std::vector<double> time(256);
    samples.on_lens(4, 5, 0, lens);
    samples.in_time(whole_shutter, 4, 5, 0, time);
    std::array<int, 32> cells{};
    for (std::size_t i = 0; i < 256; ++i)
        ++cells[std::size_t(int(time[i] * 8) * 4 + int(lens[i].x * 2) * 2 + int(lens[i].y * 2))];
    for (const int count : cells) EXPECT_NEAR(count, 8, 1);
    samples.in_time({0.25, 0.5}, 4, 5, 0, time);
    EXPECT_NEAR(*std::ranges::min_element(time), 0.25, 0.001);
    EXPECT_NEAR(*std::ranges::max_element(time), 0.5, 0.001);
    samples.in_time(moment_of(3, 4), 4, 5, 0, time);
    for (const double t : time) EXPECT_EQ(t, 0.875);
}

TEST(Sampling, AnyPartCanBeAskedFor) {
    const PixelSamples samples(100, false, 1);
    std::vector<Imath::V2d> whole(100), part(7);
    samples.in_pixel(5, -3, 0, whole);
    samples.in_pixel(5, -3, 90, part);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(part[i], whole[90 + i]);
}

TEST(Sampling, PixelsStreamsAndPairsDiffer) {
    const PixelSamples one(16, false, 1), two(16, false, 2);
    std::vector<Imath::V2d> a(16), b(16);
    one.in_pixel(0, 0, 0, a);
    one.in_pixel(1, 0, 0, b);
    EXPECT_NE(a, b);
    one.in_pixel(0, 1, 0, b);
    EXPECT_NE(a, b);
    two.in_pixel(0, 0, 0, b);
    EXPECT_NE(a, b);
    one.on_light(0, 0, 0, b);
    EXPECT_NE(a, b);
}

TEST(Sampling, SquaresAreRegularGrids) {
    std::vector<Imath::V2d> p(4), free(5);
    PixelSamples(4, true, 0).in_pixel(9, 9, 0, p);
    const std::vector<Imath::V2d> expected = {{0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}};
    EXPECT_EQ(p, expected);
    PixelSamples(5, true, 0).in_pixel(9, 9, 0, free);
    EXPECT_NE(free[0].x, free[1].x);
    PixelSamples(4, false, 0).in_pixel(9, 9, 0, p);
    EXPECT_NE(p, expected);
}

} // namespace
} // namespace sparselens::lab
