// Compares a plate with a gathered picture, block by block. In each block the plate is fitted by
//
//     plate = a + b V + c V^2 + d V_x + e V_y + f (R - V) + g (B - V)
//
// where R, G and B are those of the gathered picture and V is their mean. So exposure, grade, tone curve and a shift of
// a fraction of a pixel do not count, and the fit compares blur alone. No blur fits a block of other content, such as
// an actor, so that block says nothing.
#pragma once

#include "match/pictures.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// How the gathered picture changes with the CoC at the middle depth, the CoC at the ends of the range of depths, and the
// softness of the whole picture; then with softness along x more than y, and along the diagonals, as motion has it.
inline constexpr std::size_t most_changes = 5;
using Changes = std::array<double, most_changes>;

struct BlockFit {
    int pixels = 0;                  // that were compared; 0: too few
    double likelihood = 0;           // its logarithm, that this is the same picture, relative to a flat one
    double before = 0, left = 0;     // variances of the plate: about its mean, and about the fit
    double shift_x = 0, shift_y = 0; // of the plate against the gathered picture, pixels
    Changes pull{};                  // -1/2 the derivative of the sum of squares by each change
    std::array<Changes, most_changes> stiffness{}; // half its second derivative
};

// `changes`: derivatives of `gathered`, at most `most_changes`. `usable`: [pixel], 0: not compared.
std::vector<BlockFit> fit_blocks(const Grey &plate, std::span<const std::uint8_t> usable, const Rgb &gathered,
                                 std::span<const Rgb> changes);

} // namespace sparselens
