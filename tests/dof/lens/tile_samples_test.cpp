// The numbers and words of a tile's samples.
#include "visibility_fixture.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using Samples = std::vector<Sample>;

struct TileSamplesTest : testing::Test {
    // A pixel has two surfaces, and the rest is one.
    const TileFixture tile{[](int x, int y) {
                               Samples samples{opaque_at(2, float(x) / 64)};
                               if (x == 8 && y == 8) samples.push_back(opaque_at(6, 9));
                               return samples;
                           },
                           {{1, 0, 0, 0, 1}}};
    GatherScene scene = tile.scene();
    TileTask task = tile.task();

    static std::uint32_t number(const TileSamples &samples, std::uint32_t sample) {
        return std::uint32_t(std::ranges::find(samples.shown, sample, &TileSamples::Shown::sample) -
                             samples.shown.begin());
    }
};

TEST_F(TileSamplesTest, NearerSamplesAndOfEqualOnesTheFirstHaveGreaterWords) {
    const TileSamples samples(scene, task);
    ASSERT_EQ(samples.shown.size(), 64u * 64 + 2);
    const auto word = [&](std::uint32_t sample) {
        return *std::ranges::find(samples.opaque.words, number(samples, sample),
                                  [&](CellWord w) { return samples.number_of(w); });
    };
    const CellWord near = word(tile.sample(8, 8)), far = word(tile.sample(8, 8, 1)),
                   next = word(tile.sample(9, 8));
    EXPECT_GT(near, far);
    EXPECT_GT(near, next);
    EXPECT_EQ(samples.code_of(near), samples.code_of(next));
    EXPECT_GT(next, far);
    EXPECT_EQ(samples.colours(0)[samples.number_of(far) * 4], 9);
    EXPECT_EQ(samples.colours(0)[0], 0);
    EXPECT_TRUE(samples.is_deep);
}

// A tile without blocks but with a facet: its corners are numbered all the same.
TEST_F(TileSamplesTest, WhatFacetsShowIsNumberedWhereverItLies) {
    const std::array<std::uint32_t, 3> corners{tile.sample(20, 20), tile.sample(20, 21), tile.sample(63, 63)};
    for (std::size_t k = 0; k < 3; ++k) scene.facets.sample[k] = {corners[k]};
    scene.facets.blocks = {{0, 1, 0, 64, 0, 64, -1, 1}};
    const std::vector<std::uint32_t> facets{0};
    task.samples = {};
    task.facets = facets;
    const TileSamples samples(scene, task);
    ASSERT_EQ(samples.facets.size(), 1u);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(samples.shown[samples.number_of(samples.facets[0][k])].sample, corners[k]);
}

// The numbers take the bits that they need, and depths the rest.
TEST_F(TileSamplesTest, FewerSamplesLeaveMoreBitsToDepths) {
    const TileNumbers all = number_tile(scene, task);
    EXPECT_EQ(all.bits, 13); // of 64 x 64 + 1
    task.samples = task.samples.first(1);
    const TileNumbers few = number_tile(scene, task);
    EXPECT_EQ(few.bits, 7); // of 64
    EXPECT_NEAR(few.units.codes / all.units.codes, 64, 1);
    for (const TileNumbers &numbers : {all, few}) {
        const float most = float(std::uint32_t{1} << (31 - numbers.bits));
        EXPECT_LT((numbers.units.nearest + 1) * numbers.units.codes + 2, most);
    }
}

// A sample so near that no lens point brings it into the tile is left out; one that is brought counts.
TEST(TileSamples, OneBadDepthMakesUnitsAndDepthsNoCoarser) {
    struct Found {
        kernels::TileUnits units;
        bool is_placed;
    };
    const auto with = [](double coc, float lens_x) {
        const TileFixture tile{
            [&](int x, int y) { return Samples{opaque_at(x == 8 && y == 8 ? coc : 6, 1)}; },
            {{lens_x, 0, 0, 0, 1}}};
        const GatherScene scene = tile.scene();
        const TileTask task = tile.task();
        const TileSamples samples(scene, task);
        const std::size_t number = TileSamplesTest::number(samples, tile.sample(8, 8));
        const auto word =
            std::ranges::find(samples.opaque.words, number, [&](CellWord w) { return samples.number_of(w); });
        return Found{samples.units(),
                     samples.opaque.places.x[std::size_t(word - samples.opaque.words.begin())] > -32767};
    };
    const Found plain = with(6, 1), bad = with(-4e4, 1), seen = with(-4e4, 1e-4f), infinite = with(-1e38, 1);
    for (const Found &left_out : {bad, infinite}) {
        EXPECT_FALSE(left_out.is_placed);
        EXPECT_EQ(left_out.units.unit, plain.units.unit);
        EXPECT_EQ(left_out.units.codes, plain.units.codes);
        EXPECT_EQ(left_out.units.farthest, plain.units.farthest);
    }
    EXPECT_TRUE(plain.is_placed && seen.is_placed);
    EXPECT_NEAR(seen.units.widest, 4e4, 4);
    EXPECT_LT(seen.units.codes, plain.units.codes);
}

} // namespace
} // namespace sparselens
