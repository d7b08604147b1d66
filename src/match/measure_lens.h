// Measures how certain the values of a fitted lens are, and by how much motion blurs the plate: by the changes with
// which its picture fits the plate best.
#pragma once

#include "match/blocks.h"
#include "match/likely_lens.h"

#include <array>
#include <vector>

namespace sparselens {

// How each pixel of a lens's picture changes with the CoC at the middle depth, and with the CoC at the ends of the
// range of depths.
struct Slopes {
    Rgb by_coc, by_ends;
};

LensFit fit_with(const Comparison &pictures, const KnownLens &known, const LikelyLens &at,
                 const Slopes &slopes);

// Solves for the changes with which a gathered picture fits a plate best, over all blocks (Gauss-Newton's equations).
using Matrix = std::array<Changes, most_changes>;

struct Solution {
    Changes by{};
    Matrix covariance{}; // from how much the blocks differ from each other (White 1982)
};

// Each block counts by the noise that its fit leaves. Changes that are not free stay 0.
Solution solve_blocks(const std::vector<BlockFit> &blocks, const std::array<bool, most_changes> &is_free);

} // namespace sparselens
