// The trust in candidates: a correct one, a noisy one, and independence of the number of threads.
#include "finish/cross_validation.h"
#include "finish/synthetic.h"
#include "finish/tuning.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <numeric>

namespace sparselens {
namespace {

const ArrayGrid grid(160, 90);

struct Believed {
    Trio pictures;
    Values kept;
};

Believed believed(const LayerToFinish &layer, const Halves &candidate) {
    Believed result{{layer.gathered, layer.gathered, layer.gathered}, Values(grid.size(), 1.0f)};
    blend_in(result.pictures, candidate, {layer.rays, layer.samples, layer.grid}, result.kept);
    return result;
}

double mean(const Values &values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

TEST(Trust, TheTruthIsTaken) {
    const Colours truth = synthetic_truth(grid), wrong = blurred(truth, grid, 3);
    const LayerToFinish layer = layer_of(grid, truth, wrong, {16, 16});
    const Believed result = believed(layer, {truth, truth});
    EXPECT_GT(decibels_of(result.pictures[2], truth), decibels_of(wrong, truth) + 10);
}

TEST(Trust, NoiseIsNotTaken) {
    const Colours truth = synthetic_truth(grid);
    const LayerToFinish layer = layer_of(grid, truth, truth, {16, 16});
    const Believed result = believed(layer, {rays_of(truth, 1, 91), rays_of(truth, 1, 92)});
    EXPECT_GT(mean(result.kept), 0.99);
    EXPECT_GT(decibels_of(result.pictures[2], truth), 55);
}

// A render must not confirm the part of a candidate that was made from it.
TEST(Trust, RaysDoNotConfirmThemselves) {
    const Colours truth = synthetic_truth(grid);
    const LayerToFinish layer = layer_of(grid, truth, truth, {4, 4});
    EXPECT_GT(mean(believed(layer, layer.rays).kept), 0.99);
}

// The last channel of a black picture after it was offered a candidate. All are the same in all pixels, and there are many:
// the picture is what fits both renders best.
constexpr float unit = 1.1e-6f;
using Colour = std::array<float, 3>;
float blended(const std::array<Colour, 2> &candidate, const std::array<float, 2> &rays,
              const std::array<double, 2> &samples) {
    const ArrayGrid even(128, 64);
    Halves offered, halves;
    for (std::size_t k = 0; k < 2; ++k)
        for (const float value : candidate[k]) {
            offered[k].emplace_back(even.size(), unit * value);
            halves[k].emplace_back(even.size(), unit * rays[k]);
        }
    const Colours black(3, Values(even.size(), 0.0f));
    Trio pictures{black, black, black};
    Values kept(even.size(), 1.0f);
    blend_in(pictures, offered, {halves, samples, even}, kept);
    return pictures[2][2][even.index(Position(64, 32))] / unit;
}

TEST(Trust, RendersTestByTheirSamples) {
    const std::array<Colour, 2> white{{{1, 1, 1}, {1, 1, 1}}};
    EXPECT_NEAR(blended(white, {0.85f, 0.95f}, {1, 1}), 0.9, 1e-3);
    EXPECT_NEAR(blended(white, {0.85f, 0.95f}, {3, 1}), 0.875, 1e-3);
    EXPECT_NEAR(blended(white, {0.85f, 0.95f}, {1, 3}), 0.925, 1e-3);
}

// Both changes are (1, 1, 1) and noise, half of the square of their difference: 4 d^2.
TEST(Trust, NoiseCosts) {
    for (const double d : {0.25, 0.5}) {
        const auto more = float(1 + d), less = float(1 - d);
        EXPECT_NEAR(blended({{{more, less, 1}, {less, more, 1}}}, {1, 1}, {1, 1}),
                    3 / (3 + 2 * d * d + FinishTuning::noise_costs * 4 * d * d), 1e-3);
    }
}

// The picture of both renders has the noise of neither. With three times the samples in the first, the noise of the changes
// that are tested is 2 d^2 and 6 d^2, tested by 1 and 3: 5 d^2 on average; that of two equal halves is 3 d^2.
TEST(Trust, UnequalRendersCostTheNoiseOfBoth) {
    for (const double d : {0.25, 0.5}) {
        const auto more = float(1 + d), less = float(1 - d);
        const double energy = 3 + 2 * d * d - 5 * d * d + (1 + FinishTuning::noise_costs) * 3 * d * d;
        for (const auto &samples : {std::array<double, 2>{3, 1}, {1, 3}})
            EXPECT_NEAR(blended({{{more, less, 1}, {less, more, 1}}}, {1, 1}, samples), 3 / energy, 1e-3);
    }
}

// Pictures of noise d and -d are offered 0, and the renders confirm half of that: each change has the energy d^2, and takes
// away noise of 2 d^2.
TEST(Trust, NoiseThatIsTakenAwayCounts) {
    const ArrayGrid even(128, 64);
    const auto same = [&](float value) { return Colours(1, Values(even.size(), unit * value)); };
    Trio pictures{same(1), same(-1), same(0)};
    const Halves rays{same(-0.5f), same(0.5f)};
    Values kept(even.size(), 1.0f);
    blend_in(pictures, {same(0), same(0)}, {rays, std::array<double, 2>{1, 1}, even}, kept);
    const double costs = 2 * FinishTuning::noise_costs;
    EXPECT_NEAR(1 - pictures[0][0][even.index(Position(64, 32))] / unit, (0.5 + costs) / (1 + costs), 1e-3);
}

// Black pixels, for which the first render, of three times the samples, offers 1.
TEST(CellEvidence, WeighsRendersByTheirSamples) {
    const ArrayGrid few(8, 4);
    const Values none(few.size(), 0.0f), one(few.size(), 1.0f);
    const Halves halves{Colours{one}, Colours{none}};
    const CellEvidence found = evidence_of({Colours{none}, Colours{none}, Colours{none}}, halves,
                                           {halves, std::array<double, 2>{3, 1}, few}, {few, 2});
    EXPECT_FLOAT_EQ(found.energy[2][0], seen(0.75f) * 0.75f * 0.75f);
    // n m / (n + m) of the squared difference, over the light.
    EXPECT_DOUBLE_EQ(found.event_height, 0.75 / 0.75);
}

TEST(CellEvidence, EachPixelHasItsSamples) {
    const ArrayGrid few(8, 4);
    const Values none(few.size(), 0.0f), one(few.size(), 1.0f);
    const Halves halves{Colours{one}, Colours{none}};
    RayCounts samples({1, 1}, {Values(few.size(), 6.0f), Values(few.size(), 2.0f)});
    for (std::size_t i = 0; i < few.size(); ++i)
        if (few.position(i).column >= 4) {
            samples.by_pixel[0][i] = 1;
            samples.by_pixel[1][i] = 3;
        }
    const CellEvidence found =
        evidence_of({Colours{none}, Colours{none}, Colours{none}}, halves, {halves, samples, few}, {few, 2});
    EXPECT_FLOAT_EQ(found.energy[2][0], seen(0.75f) * 0.75f * 0.75f);
    EXPECT_FLOAT_EQ(found.energy[2][3], seen(0.25f) * 0.25f * 0.25f);
    EXPECT_FLOAT_EQ(found.samples[0][0], 6);
    EXPECT_FLOAT_EQ(found.samples[1][3], 3);
    // n m / (n + m) of the squared difference, over the light: 3/2 and 3/4, over 3/4 and 1/4.
    EXPECT_FLOAT_EQ(float(found.event_height), 2.25f);
}

// The noise of one sample must not hide what 64 prove in a quarter of the picture.
TEST(Trust, ManySamplesProveMore) {
    const Colours truth = synthetic_truth(grid), wrong = blurred(truth, grid, 3);
    LayerToFinish layer = layer_of(grid, truth, wrong, {1, 1}, 3);
    const LayerToFinish many = layer_of(grid, truth, wrong, {64, 64}, 4);
    RayCounts counts({1, 1}, {Values(grid.size(), 1.0f), Values(grid.size(), 1.0f)});
    const auto in_quarter = [](std::size_t i) { return grid.position(i).column < 40; };
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (!in_quarter(i)) continue;
        for (std::size_t k = 0; k < 2; ++k) {
            counts.by_pixel[k][i] = 64;
            for (std::size_t c = 0; c < 3; ++c) layer.rays[k][c][i] = many.rays[k][c][i];
        }
    }
    const auto decibels_of_quarter = [&](const Colours &picture) {
        Colours quarter = truth;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < grid.size(); ++i)
                if (in_quarter(i)) quarter[c][i] = picture[c][i];
        return decibels_of(quarter, truth);
    };
    const double untold = decibels_of_quarter(finished(layer).picture);
    layer.samples = counts;
    const double told = decibels_of_quarter(finished(layer).picture);
    EXPECT_GT(told, untold + 2.5);
    EXPECT_GT(told, 48);
}

TEST(Trust, ThreadsDoNotMatter) {
    const Colours truth = synthetic_truth(grid);
    const LayerToFinish layer = layer_of(grid, truth, blurred(truth, grid, 2), {16, 64});
    const auto with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const FinishedLayer result = finished(layer);
        return std::pair(result.picture, result.kept);
    };
    const auto one = with(1);
    for (const std::size_t threads : {2u, 7u}) EXPECT_EQ(with(threads), one) << threads;
}

// A lamp of radiance 30 that the gathered picture spreads too far is restored, and dark areas stay.
TEST(Trust, LightIsKept) {
    const Colours truth = synthetic_truth(grid);
    const LayerToFinish layer = layer_of(grid, truth, blurred(truth, grid, 2), {256, 256});
    const FinishedLayer result = finished(layer);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(mean(result.picture[c]), mean(truth[c]), 0.005 * mean(truth[c])) << c;
}

} // namespace
} // namespace sparselens
