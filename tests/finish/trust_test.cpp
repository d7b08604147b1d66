// The trust in candidates: a correct one, a noisy one, and independence of the number of threads.
#include "finish/synthetic.h"
#include "finish/trust.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>

namespace sparselens {
namespace {

const Grid grid(160, 90);

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
