// Means over similar pixels: some pictures stay as they are, and edges of the guide are kept.
#include "finish/finish.h"
#include "finish/synthetic.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ArrayGrid grid(45, 37); // not a multiple of the bands of 16 rows

TEST(SimilarPixels, AConstantStaysConstant) {
    const Colours guide = synthetic_truth(grid), constant(3, Values(grid.size(), 0.6f));
    for (const Colours &half : means_of_similar({constant, constant}, guide, grid))
        for (const Values &channel : half)
            for (const float v : channel) ASSERT_NEAR(v, 0.6f, 1e-5f);
}

TEST(SimilarPixels, AreLinearInTheRays) {
    const Colours guide = synthetic_truth(grid), x = rays_of(guide, 4, 1), y = rays_of(guide, 4, 2);
    Colours mixed = x;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < grid.size(); ++i) mixed[c][i] = 0.5f * x[c][i] - 2 * y[c][i];
    const Halves of_each = means_of_similar({x, y}, guide, grid),
                 of_mixed = means_of_similar({mixed, x}, guide, grid);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const float expected = 0.5f * of_each[0][c][i] - 2 * of_each[1][c][i];
            ASSERT_NEAR(of_mixed[0][c][i], expected, 1e-4f * (1 + std::abs(expected)));
            ASSERT_EQ(of_mixed[1][c][i], of_each[0][c][i]);
        }
}

// Black meets white along a diagonal: noise is averaged, and nothing crosses the edge.
TEST(SimilarPixels, KeepEdgesOfTheGuide) {
    Colours guide(1, Values(grid.size()));
    for (std::size_t i = 0; i < grid.size(); ++i)
        guide[0][i] = grid.position(i).column > grid.position(i).row ? 1.0f : 0.1f;
    const Colours rays = rays_of(guide, 1, 3);
    const Values found = means_of_similar({rays, rays}, guide, grid)[0][0];
    double before = 0, after = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        before += std::pow(double(rays[0][i] - guide[0][i]), 2);
        after += std::pow(double(found[i] - guide[0][i]), 2);
    }
    EXPECT_LT(after, before / 10); // half of 9 x 9 pixels, fewer at edges and corners
}

} // namespace
} // namespace sparselens
