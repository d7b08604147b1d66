// Separates strands thinner than a pixel, such as hair, fur and grass far away, from what is behind them.
//
// No pixel among strands shows one surface, and a renderer gives it the depth of one of its samples, so that it is
// chance whether the depth is that of hair or of what is behind. Such areas are recognised by depths that jump often
// between neighbours along rows and along columns; edges and bars mostly jump along one of them. There the depth of a
// pixel does not say what it shows more of, and single pixels around tell what the surfaces show:
//
//   - A pixel that is four times as bright as the strands holds light from between them. The light belongs to the
//     brightest pixel behind, a lamp: a = (b - c) / (b - f) of brightnesses. The same is true of a lamp that a single
//     strand crosses.
//   - Else B is what other views show behind the strands, or a farther pixel around if all of them are mixed there, too.
//     F is the strand with the smallest share, among those around that explain the colour with B, because most pixels of
//     strands are mixed. The median over all B decides.
#pragma once

#include "deep/build.h"
#include "warp/mixed/other_views.h"
#include "warp/mixed/samples_around.h"

#include <optional>
#include <vector>

namespace sparselens {

// A pixel of a view that mixes two surfaces: c = a F + (1 - a) B, where F is what the nearer one shows and B what the
// farther one does.
struct Mixture {
    double near_depth, far_depth; // perceptive
    double share;                 // a, of the nearer surface; 0: all of the pixel belongs to the farther one
    // B. The coefficients sum to 1, or to the density of a veil. The nearer surface shows the rest of the pixel.
    std::vector<Term> behind;
    std::optional<std::uint64_t> front = {}; // F, one sample; then the farther surface shows the rest
};

// Whether the pixel stands among strands: of the 20 pairs of neighbours within two pixels, five or more jump by more
// than two pixels of perceptive depth, along rows and along columns.
bool among_strands(const SamplesAround &samples, int x, int y);

// The light from between strands in a pixel among them, or in a lamp that they cross, if it has any. Perceptive: `jump`
// parts the lamp from what is behind it, `apart` the strands from both.
std::optional<Mixture> light_between_strands(const SamplesAround &samples, int x, int y, double jump,
                                             double apart);

// The share of strands in a pixel among them, if the pixels around or other views explain its colour.
std::optional<Mixture> strands_before(const SamplesAround &samples, int x, int y, const OtherViews *others);

} // namespace sparselens
