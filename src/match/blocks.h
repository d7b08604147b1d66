// Compares a plate with a gathered picture, block by block. In each block the plate is fitted by
//
//     plate = a + b V + c V^2 + d V_x + e V_y + f (R - V) + g (B - V)
//
// where R, G and B are those of the gathered picture and V is their mean. So exposure, grade, tone curve and a shift of
// a fraction of a pixel do not count, and the fit compares blur alone. No blur fits a block of other content, such as
// an actor, so that block says nothing.
#pragma once

#include "base/grid.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace sparselens {

// The pictures that dof-match compares, tone-mapped (base/light.h), so that noise and errors count everywhere as
// they do on a display.

// A grey picture: the brightness of a plate, in [0, 1), or a derivative.
struct Grey {
    Grid grid;
    std::vector<float> values; // [pixel]
};

// A picture in colour.
struct Rgb {
    Grid grid;
    std::array<std::vector<float>, 3> rgb; // [channel][pixel]
};

// Blurs scene-linear colours by a Gaussian of this variance, square pixels, as a soft lens or film does. A negative
// variance, at least -0.4, sharpens. Pixels beyond the border repeat it.
Rgb softened(const Rgb &linear, double variance);

Rgb tone_mapped(Rgb linear);

// The mean of R, G and B of tone-mapped colours.
Grey brightness(const Rgb &of);

Rgb black(const Grid &grid);

// (a - b) / step.
Rgb difference(Rgb a, const Rgb &b, double step);

// How a picture changes if it is blurred more along x than along y, and along the falling diagonal.
std::pair<Rgb, Rgb> motion_changes(const Rgb &of);

// The changes of a gathered picture that are fitted: with the CoC at the middle depth, with the CoC at the ends of the
// range of depths, with the softness of the whole picture, and the two of motion_changes().
inline constexpr std::size_t most_changes = 5;
using Changes = std::array<double, most_changes>;

struct BlockFit {
    int pixels = 0;                  // that were compared; 0: too few
    double likelihood = 0;           // logarithm of how likely the fit is, relative to a fit by a constant
    double before = 0, left = 0;     // variances of the plate: about its mean, and about the fit
    double shift_x = 0, shift_y = 0; // of the plate against the gathered picture, pixels
    Changes pull{};                  // -1/2 the derivative of the sum of squares by each change
    std::array<Changes, most_changes> stiffness{}; // half its second derivative
};

// Fits each block, row by row. `changes`: derivatives of `gathered`, at most `most_changes`. `usable`: 0: not compared.
std::vector<BlockFit> fit_blocks(const Grey &plate, std::span<const std::uint8_t> usable, const Rgb &gathered,
                                 std::span<const Rgb> changes);

// Whether a plate shows what a gathered picture shows: a block that does is fitted better in its own place than in
// other places of the plate. In a plate of another shot, one block in nine is, by chance.
struct Evidence {
    int textured = 0; // blocks of the plate that a fit explains, in some place
    int matched = 0;  // of these: blocks that are fitted best in their own place
    double matched_share() const { return textured > 0 ? double(matched) / textured : 0; }
};

Evidence find_evidence(const Grey &plate, std::span<const std::uint8_t> usable, const Rgb &gathered);

} // namespace sparselens
