#include "match/measure_lens.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

constexpr std::array<bool, most_changes> all_free{true, true, true, true, true};

// A block whose best changes are these; it has one equation for each.
BlockFit block_at(const Changes &best, double stiffness, double left = 1) {
    BlockFit block;
    block.pixels = 256;
    block.left = left;
    for (std::size_t i = 0; i < most_changes; ++i) {
        block.stiffness[i][i] = stiffness;
        block.pull[i] = stiffness * best[i];
    }
    return block;
}

TEST(Equations, blocks_that_agree_are_certain) {
    const Changes best{0.5, -1, 0.25, 0, 2};
    const Solution found = solve_blocks(std::vector<BlockFit>(8, block_at(best, 3)), all_free);
    for (std::size_t i = 0; i < most_changes; ++i) EXPECT_NEAR(found.by[i], best[i], 1e-12);
}

TEST(Equations, a_block_with_less_noise_counts_more) {
    const std::vector<BlockFit> blocks{block_at({1, 0, 0, 0, 0}, 1, 1), block_at({5, 0, 0, 0, 0}, 1, 3)};
    EXPECT_NEAR(solve_blocks(blocks, all_free).by[0], (1 + 5 / 3.0) / (1 + 1 / 3.0), 1e-12);
}

TEST(Equations, changes_that_are_not_free_stay) {
    BlockFit block = block_at({1, 2, 3, 4, 5}, 1);
    block.stiffness[0][1] = block.stiffness[1][0] = 0.5;
    const Solution found = solve_blocks({block}, {true, false, true, true, true});
    EXPECT_EQ(found.by[1], 0);
    EXPECT_NEAR(found.by[0], 1, 1e-12);
    EXPECT_EQ(found.covariance[1][1], 0);
}

// The mean of n values has the n-th part of their variance, and three degrees of freedom go to the lens.
TEST(Equations, the_covariance_is_that_of_the_mean) {
    std::vector<BlockFit> blocks;
    for (int i = 0; i < 100; ++i) blocks.push_back(block_at({i % 2 == 0 ? 1.0 : -1.0, 0, 0, 0, 0}, 2));
    const Solution found = solve_blocks(blocks, all_free);
    EXPECT_NEAR(found.by[0], 0, 1e-12);
    EXPECT_NEAR(found.covariance[0][0], 1.0 / 97, 1e-12);
}

} // namespace
} // namespace sparselens
