// Solves for the changes with which a gathered picture fits a plate best, over all blocks (Gauss-Newton's equations).
#pragma once

#include "match/blocks.h"

#include <array>
#include <vector>

namespace sparselens {

using Matrix = std::array<Changes, most_changes>;

struct Solution {
    Changes by{};
    Matrix covariance{}; // from how much the blocks differ from each other (White 1982)
};

// Each block counts by the noise that its fit leaves. Changes that are not free stay 0.
Solution solve_blocks(const std::vector<BlockFit> &blocks, const std::array<bool, most_changes> &is_free);

} // namespace sparselens
