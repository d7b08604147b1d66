// The tone curve of a plate: an exposure, a grade, a camera's curve and the clipping of highlights are, together, one
// rising function of each channel. It is found by comparing the plate with a gathered picture pixel by pixel.
#pragma once

#include "match/pictures.h"

#include <cstdint>
#include <span>

namespace sparselens {

// Gives the tone-mapped picture the curve at which each of its channels is nearest to that of the plate: the mean
// of the plate over the pixels of about one value, made rising (isotonic regression, Ayer et al. 1955). Blocks that
// differ much more than most, such as those of an actor, hardly count. `usable`: [pixel], 0: not compared.
Rgb with_curve_of(const Rgb &plate, std::span<const std::uint8_t> usable, const Rgb &shown);

} // namespace sparselens
