// Frames around: what stays the same is averaged, what changes is not.
#include "finish/frames_around.h"
#include "finish/synthetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace sparselens {
namespace {

const ArrayGrid grid(96, 64);

// Each render has 16 rays and a seed of its own.
FrameOfLayer frame_of(const Colours &truth, const Colours &gathered, std::uint32_t seed) {
    return {gathered, {rays_of(truth, 16, 2 * seed), rays_of(truth, 16, 2 * seed + 1)}};
}

double squared_error(const FrameOfLayer &frame, const Colours &truth) {
    double sum = 0;
    for (std::size_t c = 0; c < truth.size(); ++c)
        for (std::size_t i = 0; i < grid.size(); ++i)
            sum += std::pow(
                (double(frame.rays[0][c][i]) + double(frame.rays[1][c][i])) / 2 - double(truth[c][i]), 2);
    return sum;
}

Colours brighter(Colours colours, float factor) {
    for (Values &channel : colours)
        for (float &v : channel) v *= factor;
    return colours;
}

double mean_of(const Values &values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

// The truth, moved to the right by some pixels; its border goes on.
Colours moved(const Colours &truth, int by) {
    Colours result = truth;
    for (std::size_t c = 0; c < truth.size(); ++c)
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const Position at = grid.position(i);
            result[c][i] =
                truth[c][grid.index(Position(std::clamp(at.column - by, 0, grid.width() - 1), at.row))];
        }
    return result;
}

// Five frames of one picture are as good as five times the rays, also where all gathered pictures err.
TEST(FramesAround, OfAStillAreMoreRays) {
    const Colours truth = synthetic_truth(grid), wrong = brighter(blurred(truth, grid, 2), 0.9f);
    FrameOfLayer frame = frame_of(truth, wrong, 1);
    const double alone = squared_error(frame, truth);
    std::vector<FrameOfLayer> around;
    for (std::uint32_t seed = 2; seed < 6; ++seed) around.push_back(frame_of(truth, wrong, seed));
    frame.rays = averaged_rays(frame, around, grid);
    EXPECT_LT(squared_error(frame, truth), 0.3 * alone);
    EXPECT_GT(squared_error(frame, truth), 0.18 * alone);
}

// The picture moves, and each gathered picture is blurred: residuals at edges belong to their frame alone.
TEST(FramesAround, DoNotSmearWhatMoves) {
    const Colours truth = synthetic_truth(grid);
    FrameOfLayer frame = frame_of(truth, blurred(truth, grid, 3), 1);
    const double alone = squared_error(frame, truth);
    std::vector<FrameOfLayer> around;
    for (int by : {-8, -4, 4, 8}) {
        const Colours other = moved(truth, by);
        around.push_back(frame_of(other, blurred(other, grid, 3), std::uint32_t(20 + by)));
    }
    frame.rays = averaged_rays(frame, around, grid);
    EXPECT_LT(squared_error(frame, truth), alone);
}

TEST(FramesAround, AnotherErrorCountsLittle) {
    const Colours truth = synthetic_truth(grid);
    const FrameOfLayer frame = frame_of(truth, truth, 1), same = frame_of(truth, truth, 2),
                       other = frame_of(truth, brighter(truth, 0.5f), 3);
    EXPECT_GT(mean_of(weight_of(frame, same, 1, grid)), 0.8);
    EXPECT_LT(mean_of(weight_of(frame, other, 1, grid)), 0.25);
}

// Where the squares of the noise and of the change, s^2 and b^2, are everywhere the same, so is s^2 / (s^2 + 2 n b^2).
TEST(FramesAround, HaveTheWeightsOfLeastSquares) {
    const auto even = [](float value) { return Colours(1, Values(grid.size(), value)); };
    const FrameOfLayer frame{even(0), {even(0.1f), even(-0.1f)}}, other{even(0), {even(0.2f), even(0)}};
    for (const std::size_t frames : {1u, 4u})
        for (const float weight : weight_of(frame, other, frames, grid))
            ASSERT_NEAR(weight, 0.02 / (0.02 + 2 * double(frames) * 0.01), 1e-4) << frames;
}

// A noisier frame counts less, and a frame without noise needs no other.
TEST(FramesAround, CountByTheirNoise) {
    const Colours truth = synthetic_truth(grid);
    const FrameOfLayer frame = frame_of(truth, truth, 1);
    const FrameOfLayer noisy{truth, {rays_of(truth, 4, 90), rays_of(truth, 4, 91)}};
    EXPECT_NEAR(mean_of(weight_of(frame, noisy, 1, grid)), 0.25, 0.08);
    const FrameOfLayer clean{truth, {truth, truth}};
    for (const float weight : weight_of(clean, frame, 1, grid)) ASSERT_EQ(weight, 0);
    for (const float weight : weight_of(clean, clean, 1, grid)) ASSERT_EQ(weight, 0);
}

// Beside a lamp whose noise is huge, pixels with next to none: running sums lose them.
TEST(FramesAround, WeightsLieBetweenNoneAndAll) {
    const Colours black(3, Values(grid.size(), 0.0f));
    const auto with_lamp = [&](float first, float second) {
        FrameOfLayer frame{black, {black, black}};
        for (std::size_t c = 0; c < 3; ++c)
            for (int x = 10; x < 30; ++x) {
                const bool lamp = x > 20 && x < 24;
                frame.rays[0][c][grid.index(Position(x, 30))] = lamp ? first : 1e-5f * float(x);
                frame.rays[1][c][grid.index(Position(x, 30))] = lamp ? second / float(x) : 1e-5f / float(x);
            }
        return frame;
    };
    const FrameOfLayer frame = with_lamp(1e4f, 3.3e3f), other = with_lamp(7.7e3f, 1.1e4f);
    for (const float weight : weight_of(frame, other, 1, grid)) {
        ASSERT_GE(weight, 0);
        ASSERT_LE(weight, 1);
    }
}

TEST(FramesAround, NoneChangeNothing) {
    const Colours truth = synthetic_truth(grid);
    FrameOfLayer frame = frame_of(truth, blurred(truth, grid, 2), 1);
    const Halves before = frame.rays;
    frame.rays = averaged_rays(frame, {}, grid);
    for (std::size_t h = 0; h < 2; ++h)
        for (std::size_t c = 0; c < truth.size(); ++c)
            for (std::size_t i = 0; i < grid.size(); ++i)
                ASSERT_NEAR(frame.rays[h][c][i], before[h][c][i], 1e-5f);
}

} // namespace
} // namespace sparselens
