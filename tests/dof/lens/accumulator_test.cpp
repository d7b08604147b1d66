// The sums that lens points contribute, by closed forms, for hand-made visible samples.
#include "dof/lens/accumulator.h"
#include "visibility_fixture.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using Samples = std::vector<Sample>;
using tile_cells::at;

constexpr int x = 12, y = 34; // the tested pixel
constexpr std::size_t pixel = y * 64 + x;

// Three samples: a partial one; one behind focus, of value 2; an opaque one in front of focus, of value 8.
struct AccumulatorTest : testing::Test {
    const TileFixture tile{[](int column, int row) {
                               if (column == 1 && row == 1) return Samples{opaque_at(-3, 8)};
                               if (column == 0 && row == 0) return Samples{partial_at(2, .25f, 4)};
                               return Samples{opaque_at(4, 2)};
                           },
                           {{0, 0, 0, 0, 1}}};
    const GatherScene scene = tile.scene();
    const TileTask task = tile.task();
    const TileSamples samples{scene, task};
    const std::uint32_t behind = tile.sample(x, y), in_front = tile.sample(1, 1);

    // A lens point that sees nothing at the pixel; the partial sample is elsewhere.
    static Visibility nothing() {
        Visibility seen;
        seen.columns.fill({0, 64});
        seen.unknown.fill(~std::uint64_t{});
        seen.front.resize(tile_cells::count);
        seen.partial_cells = {0};
        return seen;
    }
    // ... with an opaque sample at the pixel.
    Visibility opaque(std::uint32_t sample) const {
        const auto number =
            std::ranges::find(samples.shown, sample, &TileSamples::Shown::sample) - samples.shown.begin();
        const kernels::TileUnits &units = samples.units();
        Visibility seen = nothing();
        seen.front[at(x, y)] = samples.word_of(
            kernels::depth_code(tile.blocked.samples.upper[sample], units.nearest, units.codes),
            CellWord(number));
        seen.unknown[y] ^= std::uint64_t{1} << x;
        return seen;
    }
    // The same behind the partial sample.
    static Visibility covered(Visibility seen) {
        seen.partial_cells = {std::uint16_t(at(x, y))};
        return seen;
    }
    struct Mean {
        float value, known;
    };
    // The mean of channel Y over lens points with their visible samples.
    Mean mean(const std::vector<std::pair<LensSample, Visibility>> &points, bool two_sided = false,
              const LensLooks &looks = {}) const {
        const GatherScene by_looks = tile.scene(looks);
        Accumulator sums(by_looks, samples, task.origin, two_sided);
        for (const auto &[point, seen] : points) sums.add(seen, point);
        const TilePicture picture = sums.picture();
        EXPECT_EQ(picture.is_known(pixel), picture.known[pixel] > 0);
        return {picture.value(pixel, 0), picture.known[pixel]};
    }
};

constexpr LensSample point{0, 0, 0, 0, .5f}, heavy{0, 0, 0, 0, 1.5f};

TEST_F(AccumulatorTest, AllSeeOneSample) {
    const Mean even = mean({{point, opaque(behind)}, {heavy, opaque(behind)}});
    EXPECT_FLOAT_EQ(even.value, 2);
    EXPECT_FLOAT_EQ(even.known, 2);
}

TEST_F(AccumulatorTest, EachCountsByItsWeight) {
    EXPECT_FLOAT_EQ(mean({{point, opaque(behind)}, {heavy, opaque(in_front)}}).value, (2 + 3 * 8) / 4.f);
}

TEST_F(AccumulatorTest, WhatIsUnknownDoesNotCount) {
    const Mean half = mean({{point, opaque(behind)}, {heavy, nothing()}});
    EXPECT_FLOAT_EQ(half.value, 2);
    EXPECT_FLOAT_EQ(half.known, .5f);
    EXPECT_EQ(mean({{point, nothing()}}).known, 0);
}

TEST_F(AccumulatorTest, APartialSampleLetsTheRestThrough) {
    EXPECT_FLOAT_EQ(mean({{point, covered(opaque(behind))}}).value, .25f * 4 + .75f * 2);
    EXPECT_FLOAT_EQ(mean({{point, covered(opaque(in_front))}}).value, 8) << "it is behind that";
}

TEST_F(AccumulatorTest, APartialSampleBeforeTheUnknownCountsByItsCoverage) {
    const Mean alone = mean({{point, covered(nothing())}});
    EXPECT_FLOAT_EQ(alone.value, 4);
    EXPECT_FLOAT_EQ(alone.known, .25f * .5f);
}

TEST_F(AccumulatorTest, ColoursAndSidesCountByTheirs) {
    const LensSample green_rim{0, 0, 0, 0, 1, {1, 3, 1}, {9, .5f, 9}, {9, 1.5f, 9}},
        rim{0, 0, 0, 0, 1, {1, 1, 1}, {9, 1.5f, 9}, {9, .5f, 9}};
    const float by_side = mean({{green_rim, opaque(in_front)}, {rim, opaque(behind)}}, true).value;
    EXPECT_FLOAT_EQ(by_side, (3 * 1.5f * 8 + 1.5f * 2) / (3 * 1.5f + 1.5f));
    const float one_side = mean({{green_rim, opaque(behind)}, {rim, covered(opaque(behind))}}).value;
    EXPECT_FLOAT_EQ(one_side, (1.5f * 2 + 1.5f * (.25f * 4 + .75f * 2)) / 3);
}

// A cat's eye lets one of two lens points through at that pixel. The result is the mean light at that point, whatever
// the point's weight; with darkening, the light times that weight.
TEST_F(AccumulatorTest, ACatsEyeLeavesOutOrDarkens) {
    const LensSample bright{0, 0, 0, 0, .5f, {1, 3, 1}};
    Visibility beside = opaque(in_front);
    beside.columns[y] = {x + 1, 64};
    beside.front[at(x, y)] = 0;
    beside.unknown.fill(~std::uint64_t{});
    for (const bool darkens : {false, true}) {
        LensLooks looks;
        looks.cat_eye = 1;
        looks.cat_eye_darkening = darkens;
        const Mean cut = mean({{bright, opaque(behind)}, {point, beside}}, false, looks);
        EXPECT_FLOAT_EQ(cut.value, darkens ? 6 : 2);
        EXPECT_FLOAT_EQ(cut.known, darkens ? .5f : 1.5f);
    }
}

} // namespace
} // namespace sparselens
