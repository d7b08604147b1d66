#include "dof/lens/sample_blocks.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

bool is_background(const BlockedSamples &samples, std::size_t i) {
    return samples.source[i] == BlockedSamples::background;
}

TEST(SampleBlocks, HoldEverySampleOnceAtItsPlace) {
    Windows windows = windows_of_size(45, 21);
    windows.data = {{-13, 4}, {31, 24}};
    Ldi ldi = random_surfaces(windows, lens, false, 1);
    ldi.image_z = ldi.z;
    for (std::size_t i = 0; i < ldi.samples(); i += 3) ldi.image_z[i] = 1 / (0.3f - 0.1f * float(i % 5));
    const BlockedSamples samples = make_blocks(ldi, lens, ldi.windows.data);
    std::vector<int> pixel_of(ldi.samples());
    for (std::size_t p = 0; p < windows.pixels(); ++p)
        for (std::uint64_t i = ldi.begin[p]; i < ldi.begin[p + 1]; ++i) pixel_of[i] = int(p);
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i < samples.count(); ++i) {
        if (is_background(samples, i)) continue;
        const std::uint32_t s = samples.source[i];
        EXPECT_TRUE(seen.insert(s).second);
        EXPECT_FLOAT_EQ(samples.x[i], float(pixel_of[s] % 45) + 0.5f + ldi.dx[s]);
        EXPECT_FLOAT_EQ(samples.y[i], float(pixel_of[s] / 45) + 0.5f + ldi.dy[s]);
        EXPECT_FLOAT_EQ(samples.coc[i], float(circle_of_confusion(lens, ldi.coc_z(s))));
        EXPECT_FLOAT_EQ(samples.depth(i), float(disparity(lens, double(ldi.z[s]))));
        EXPECT_EQ(samples.alpha[i], ldi.values[ldi.alpha()][s]);
    }
    EXPECT_EQ(seen.size(), ldi.samples());
}

TEST(SampleBlocks, TellWhereTheSamplesOfTheLdiAre) {
    const Ldi ldi = random_surfaces(windows_of_size(45, 37), lens, false, 2);
    const BlockedSamples samples = make_blocks(ldi, lens, ldi.windows.data);
    for (const auto &[top, bottom] : {std::pair(0, 16), std::pair(16, 32), std::pair(32, 37)}) {
        const SamplePlaces places(samples, ldi, top, bottom);
        for (std::size_t pixel = std::size_t(top) * 45; pixel < std::size_t(bottom) * 45; ++pixel)
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                EXPECT_EQ(samples.source[places.of(i)], i);
                EXPECT_EQ(place_of(samples, ldi, pixel, i), places.of(i));
            }
    }
}

TEST(SampleBlocks, FollowEachOtherAndBoundWhatTheyHold) {
    const Ldi ldi = random_surfaces(windows_of_size(45, 21), lens, false, 2);
    const BlockedSamples samples = make_blocks(ldi, lens, ldi.windows.data);
    ASSERT_EQ(samples.blocks.size(), std::size_t(samples.columns * samples.rows));
    std::uint32_t next = 0;
    for (std::size_t b = 0; b < samples.blocks.size(); ++b) {
        const SampleBlock &block = samples.blocks[b];
        EXPECT_EQ(block.begin, next);
        next = block.end;
        ASSERT_LE(block.begin, block.opaque_end);
        ASSERT_LE(block.opaque_end, block.end);
        const int column = int(b) % samples.columns, row = int(b) / samples.columns;
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            EXPECT_EQ(samples.alpha[i] == 1, i < block.opaque_end);
            EXPECT_TRUE(samples.x[i] >= block.x_min && samples.x[i] <= block.x_max);
            EXPECT_TRUE(samples.y[i] >= block.y_min && samples.y[i] <= block.y_max);
            EXPECT_TRUE(samples.coc[i] >= block.coc_min && samples.coc[i] <= block.coc_max);
            EXPECT_EQ(int(samples.x[i]) / BlockedSamples::size, column);
            EXPECT_EQ(int(samples.y[i]) / BlockedSamples::size, row);
        }
    }
    EXPECT_EQ(next, samples.count());
}

TEST(SampleBlocks, KnowTheBackgroundWhereLightComesThrough) {
    // Coverage: none; half; less than full; almost full, by two samples; full; full up to rounding in half.
    const std::vector<std::vector<float>> alphas{{},        {0.5f},    {0.5f, 0.9f}, {0.99f, 0.99f},
                                                 {0.3f, 1}, {0.99999f}};
    Windows windows = windows_of_size(int(alphas.size()), 2);
    const Ldi ldi = make_ldi(windows, {{"A"}}, [&](int x, int) {
        std::vector<Sample> samples;
        for (const float a : alphas[std::size_t(x)]) samples.push_back({double(samples.size() + 1), {a}});
        return samples;
    });
    const BlockedSamples samples =
        make_blocks(ldi, lens, Imath::Box2i({0, 0}, {5, 0})); // nothing is known of the second row
    std::set<std::pair<float, float>> clear;
    for (std::size_t i = 0; i < samples.count(); ++i) {
        if (!is_background(samples, i)) continue;
        EXPECT_EQ(samples.y[i], 0.5f);
        EXPECT_EQ(samples.depth(i), 0);
        EXPECT_EQ(samples.alpha[i], 1);
        clear.insert({samples.x[i], samples.coc[i]});
    }
    const auto coc = [](double z) { return float(circle_of_confusion(lens, z)); };
    // At infinity, and at the depth of the last sample.
    const std::set<std::pair<float, float>> expected{
        {0.5f, coc(inf)}, {1.5f, coc(inf)}, {1.5f, coc(1)}, {2.5f, coc(inf)}, {2.5f, coc(2)}};
    EXPECT_EQ(clear, expected);
}

TEST(SampleBlocks, WithoutCoverageAllSamplesAreOpaque) {
    const Ldi ldi = make_ldi(windows_of_size(9, 9), {{"Y"}}, [](int, int) {
        return std::vector<Sample>{{2, {1}}, {inf, {1}}};
    });
    for (const SampleBlock &block : make_blocks(ldi, lens, ldi.windows.data).blocks)
        EXPECT_EQ(block.opaque_end, block.end);
}

TEST(SampleBlocks, UppersGoByDepth) {
    const Ldi ldi = random_surfaces(windows_of_size(45, 21), lens, false, 3);
    const BlockedSamples samples = make_blocks(ldi, lens, ldi.windows.data);
    std::set<std::pair<std::uint32_t, float>> uppers;
    for (std::size_t i = 0; i < samples.count(); ++i) uppers.insert({samples.upper[i], samples.depth(i)});
    EXPECT_GT(uppers.size(), 20u);
    EXPECT_GT(uppers.begin()->first, 0u);
    float last = -1;
    for (const auto &[upper, depth] : uppers) {
        EXPECT_GE(depth, last);
        last = depth;
    }
}

TEST(SampleBlocks, BackgroundsLieBehindWhatIsAtInfinity) {
    const Ldi ldi = make_ldi(windows_of_size(20, 20), {{"A"}}, [](int, int) {
        return std::vector<Sample>{{inf, {0.5f}}};
    });
    const BlockedSamples samples = make_blocks(ldi, lens, ldi.windows.data);
    std::uint32_t farthest_sample = ~0u, nearest_background = 0;
    for (std::size_t i = 0; i < samples.count(); ++i) {
        if (is_background(samples, i))
            nearest_background = std::max(nearest_background, samples.upper[i]);
        else
            farthest_sample = std::min(farthest_sample, samples.upper[i]);
    }
    EXPECT_LT(nearest_background, farthest_sample);
}

} // namespace
} // namespace sparselens
