// Regressions of rays on a guide: closed forms.
#include "finish/finish.h"
#include "finish/synthetic.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ArrayGrid grid(48, 32);

Values with(const Values &guide, float a, float b) {
    Values values = guide;
    for (float &v : values) v = a + b * v;
    return values;
}

struct RegressionTest : testing::Test {
    Colours guide = synthetic_truth(grid);
    Values weights = tone_weights(guide);
};

TEST_F(RegressionTest, WeightsAreThoseOfTheToneCurve) {
    const Colours colours{{1, -5, 0}, {3, 0, 0}, {2, 0, 0}};
    const Values found = tone_weights(colours);
    EXPECT_FLOAT_EQ(found[0], 1.0f / 9);
    EXPECT_FLOAT_EQ(found[1], 1); // darker than black counts as black
    EXPECT_FLOAT_EQ(found[2], 1);
}

// A straight line is found exactly at any brightness.
TEST_F(RegressionTest, AStraightLineOfTheGuideIsFound) {
    for (const FinishTuning::Window window : {FinishTuning::Window{1, 1}, {2, 4}, {4, 2}}) {
        const Values rays = with(guide[0], 0.25f, 0.8f),
                     found = Regression(guide[0], weights, grid, window).of(rays);
        for (std::size_t i = 0; i < rays.size(); ++i)
            ASSERT_NEAR(found[i], rays[i], 1e-4f * (1 + std::abs(rays[i]))) << i;
    }
}

// Half of the picture follows the guide, half does not: each half gets its own slope where the guide varies more than
// the prior.
TEST_F(RegressionTest, SlopesAreLocal) {
    Values stripes(grid.size());
    for (std::size_t i = 0; i < stripes.size(); ++i) stripes[i] = i % 2 == 0 ? 1.0f : -0.9f;
    const Values flat(grid.size(), 1.0f);
    Values rays = with(stripes, 0.5f, -2);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (grid.position(i).column >= 24) rays[i] = 0.1f + stripes[i];
    const Values found = Regression(stripes, flat, grid, {1, 2}).of(rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (std::abs(grid.position(i).column - 24) > 7) {
            ASSERT_NEAR(found[i], rays[i], 0.02f) << i;
        }
}

TEST_F(RegressionTest, AConstantGuideGivesTheMean) {
    const Values constant(grid.size(), 0.5f), flat(grid.size(), 1.0f), rays(grid.size(), 0.8f);
    for (const float v : Regression(constant, flat, grid, {2, 4}).of(rays)) EXPECT_NEAR(v, 0.8f, 1e-5f);
}

TEST_F(RegressionTest, IsLinearInTheRays) {
    const Regression regression(guide[1], weights, grid, {2, 1});
    const Colours rays = rays_of(guide, 4, 7);
    Values mixed = rays[0];
    for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = 2 * rays[0][i] - 0.5f * rays[2][i];
    const Values of_first = regression.of(rays[0]), of_third = regression.of(rays[2]),
                 found = regression.of(mixed);
    for (std::size_t i = 0; i < mixed.size(); ++i)
        ASSERT_NEAR(found[i], 2 * of_first[i] - 0.5f * of_third[i], 1e-4f * (1 + std::abs(found[i]))) << i;
}

} // namespace
} // namespace sparselens
