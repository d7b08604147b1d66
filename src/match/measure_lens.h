// Measures how certain the values of a fitted lens are, and by how much motion blurs the plate: by the changes with
// which its picture fits the plate best.
#pragma once

#include "match/blocks.h"
#include "match/lens_search.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

struct LikelyLens {
    BlurGuess guess;
    double likelihood = 0;
    Rgb linear, shown; // its picture: as gathered, and as the plate shows it
};

// `guess`, moved to where allowed() permits, with its pictures and its likelihood.
LikelyLens compared(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess);

// The same, with the softness that fits best in place of the guess's. It gathers only one picture.
LikelyLens softest(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess);

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

// The quadratic function of two numbers that fits values at some places, as searches without derivatives use it
// (Powell 2002, Conn, Scheinberg and Vicente 2009).
struct Place {
    double x = 0, y = 0;
};

double distance(const Place &a, const Place &b);

// 1, x, y, x^2 / 2, x y, y^2 / 2
inline constexpr std::size_t quadratic_terms = 6;

class Quadratic {
public:
    // Around `middle`; x and y count in units of `reach`, > 0. A term that the places do not determine is small.
    Quadratic(std::span<const Place> places, const Place &middle, double reach);

    // The share that each place's value has in a term: the term is the sum of shares times values.
    std::span<const double> shares(std::size_t term) const { return shares_[term]; }

    // The place of the largest value, at most `reach` away from the middle.
    Place best(std::span<const double> values) const;

private:
    Place middle_;
    double reach_;
    std::array<std::vector<double>, quadratic_terms> shares_;
};

} // namespace sparselens
