// Where rays are asked for, in closed form: errors that fall as one over the rays, on the left and on the right.
#include "finish/ask_rays.h"
#include "finish/tuning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparselens {
namespace {

const Grid grid = windows_of_size(64, 32).grid();

bool is_left(std::size_t i) { return grid.pixel(i).x < 32; }

Values split(float left, float right) {
    Values values(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) values[i] = is_left(i) ? left : right;
    return values;
}

// Twice the rays halve it.
ErrorEstimate error_of(Values map) {
    double mean = 0;
    for (const float e : map) mean += double(e) / double(grid.size());
    return {std::move(map), mean, mean / 100, 2 * mean};
}

void expect_asked(const AskedRays &asked, float left, float right) {
    for (std::size_t i = 0; i < grid.size(); ++i)
        ASSERT_NEAR(asked.more[i], is_left(i) ? left : right, 1e-2) << i;
    std::size_t expected = 0;
    for (const float count : {left, right}) expected += count > 0;
    ASSERT_EQ(asked.rectangles.size(), expected);
    for (const auto &[box, samples] : asked.rectangles) {
        const bool first = box.min.x == 0;
        EXPECT_EQ(box, (first ? Imath::Box2i({0, 0}, {31, 31}) : Imath::Box2i({32, 0}, {63, 31})));
        EXPECT_EQ(samples, int(first ? left : right));
    }
}

// Four times the error of one ray takes twice the rays.
TEST(AskRays, RaysGoAsTheRootOfTheError) {
    const ErrorEstimate error = error_of(split(16e-5f, 4e-5f));
    expect_asked(ask_rays(error, std::array<double, 2>{5, 5}, grid, grid.box(), 60), 70, 30);
    // Rays that are there are not taken away: with 80 on the left, 20 remain on the right.
    const ErrorEstimate steep = error_of(split(64e-5f, 1e-5f));
    expect_asked(ask_rays(steep, std::array<double, 2>{10, 10}, grid, grid.box(), 50), 60, 0);
}

// The left has had twice the rays, and has half of the error: it needs as many in all.
TEST(AskRays, KnowsTheSamplesOfEachPixel) {
    const RayCounts samples({15, 15}, {split(20, 10), split(20, 10)});
    expect_asked(ask_rays(error_of(split(32e-5f, 1e-5f)), samples, grid, grid.box(), 50), 40, 0);
}

// With 80 and 20 rays, errors of 64e-5 and 4e-5 from 20 rays become 16e-5 and 4e-5.
TEST(AskRays, ReachesAnError) {
    ErrorEstimate error = error_of(split(64e-5f, 4e-5f));
    expect_asked(ask_rays(error, std::array<double, 2>{10, 10}, grid, grid.box(), 0, 10e-5), 60, 0);
    // A map has no error below 0, so it may show more than there is on average.
    error.mean /= 2, error.of_one /= 2;
    expect_asked(ask_rays(error, std::array<double, 2>{10, 10}, grid, grid.box(), 0, 5e-5), 60, 0);
}

// If the error falls more slowly, more of the rays go where it is large: as its power of 2/3 if twice the rays leave
// 1 / sqrt(2) of it.
TEST(AskRays, SlowFallsTakeMore) {
    ErrorEstimate error = error_of(split(8e-5f, 1e-5f));
    error.of_one = error.mean * std::sqrt(2.0);
    expect_asked(ask_rays(error, std::array<double, 2>{5, 5}, grid, grid.box(), 50), 70, 10);
}

// Whatever is wished, no pixel is asked for more than a renderer takes.
TEST(AskRays, CountsAreLimited) {
    const ErrorEstimate error = error_of(split(64e-5f, 4e-5f));
    const std::array<double, 2> samples{10, 10};
    for (const AskedRays &asked : {ask_rays(error, samples, grid, grid.box(), 1e12),
                                   ask_rays(error, samples, grid, grid.box(), 0, 1e-200)}) {
        for (const float more : asked.more) ASSERT_EQ(more, 1e6f - 20);
        ASSERT_EQ(asked.rectangles.size(), 1u);
        EXPECT_EQ(asked.rectangles[0], std::pair(grid.box(), 1000000 - 20));
    }
}

// Pixels outside of those that may need rays get none, and do not count in the mean.
TEST(AskRays, AsksInItsPixelsAlone) {
    const Imath::Box2i left({0, 0}, {15, 15});
    const AskedRays asked =
        ask_rays(error_of(split(64e-5f, 64e-5f)), std::array<double, 2>{10, 10}, grid, left, 50);
    for (std::size_t i = 0; i < grid.size(); ++i)
        ASSERT_NEAR(asked.more[i], left.intersects(grid.pixel(i)) ? 30 : 0, 1e-3) << i;
    ASSERT_EQ(asked.rectangles.size(), 1u);
    EXPECT_EQ(asked.rectangles[0], std::pair(left, 30));
}

TEST(AskRays, FewRectanglesApartCostAsMuch) {
    const Grid large = windows_of_size(200, 120).grid();
    Values map(large.size(), 1e-6f);
    for (const Imath::V2i &spot : {Imath::V2i(8, 16), {72, 96}, {100, 40}, {184, 8}, {160, 100}})
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) map[large.index(spot + Imath::V2i(x, y))] = 1e-3f;
    const AskedRays asked =
        ask_rays({map, 1e-4, 1e-6, 2e-4}, std::array<double, 2>{20, 20}, large, large.box(), 80);
    double rays = 0, by_rectangles = 0;
    for (const float more : asked.more) rays += double(more);
    EXPECT_NEAR(rays / double(large.size()), 40, 0.01);
    EXPECT_GE(asked.rectangles.size(), 5u);
    EXPECT_LE(asked.rectangles.size(), FinishTuning::most_pieces);
    Values covered(large.size(), 0.0f);
    for (const auto &[box, samples] : asked.rectangles) {
        EXPECT_EQ(samples % 2, 0);
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                by_rectangles += samples;
                covered[large.index(Imath::V2i(x, y))] += 1;
            }
    }
    EXPECT_NEAR(by_rectangles / double(large.size()), 40, 1);
    EXPECT_LE(*std::ranges::max_element(covered), 1);
}

} // namespace
} // namespace sparselens
