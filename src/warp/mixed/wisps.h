// Strands thinner than a pixel: hair, fur, grass far away.
//
// No pixel among them shows one surface, and the depth that a renderer gives it is that of one of its samples, so that
// it is chance whether a pixel is said to be hair or what is behind. Such places are known by depths that jump often
// between neighbours, along rows and along columns, where edges and bars mostly do along one of them. There the depth of a
// pixel does not say what it shows more of, and what the surfaces show is told by single pixels around:
//
//   - A pixel that is four times as bright as the strands are holds light from between them. It belongs to the brightest
//     pixel behind, a lamp: a = (b - c) / (b - f) of brightnesses. The same is true of a lamp that a single strand crosses.
//   - Else B is the one of the farther pixels that leaves most of the pixel to the strands and still explains its colour, and F
//     the one of the strands that differs most from B.
#pragma once

#include "deep/build.h"
#include "warp/mixed/samples_around.h"

#include <optional>
#include <vector>

namespace sparselens {

// A pixel of a view that mixes two surfaces: c = a F + (1 - a) B, where F is what the nearer one shows and B what the
// farther one does.
struct Mixture {
    double near_depth, far_depth; // perceptive
    double share;                 // a, of the nearer surface; 0: all of the pixel belongs to the farther one
    std::vector<Term> behind; // B; the coefficients sum to 1. The nearer surface shows the rest of the pixel
    std::optional<std::uint64_t> front = {}; // F, one sample; then the farther surface shows the rest
};

// Whether the pixel stands among strands: of the 20 pairs of neighbours within two pixels, five or more jump by more than
// two pixels of perceptive depth, along rows and along columns.
bool among_strands(const SamplesAround &samples, int x, int y);

// The light from between strands in a pixel among them, or in a lamp that they cross, if it has any. Perceptive: `jump`
// parts the lamp from what is behind it, `apart` the strands from both.
std::optional<Mixture> light_between_strands(const SamplesAround &samples, int x, int y, double jump,
                                             double apart);

// The share of strands in a pixel among them, if the pixels around explain its colour.
std::optional<Mixture> strands_before(const SamplesAround &samples, int x, int y);

} // namespace sparselens
