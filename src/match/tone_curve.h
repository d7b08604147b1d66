// The tone curve of a plate: an exposure, a grade, a camera's curve and the clipping of highlights are, together, one
// rising function of each channel. It is found by comparing the plate with a gathered picture pixel by pixel.
#pragma once

#include "match/blocks.h"

#include <cstdint>
#include <span>

namespace sparselens {

// Gives the tone-mapped picture the curve at which each of its channels is nearest to that of the plate: the mean
// of the plate over the pixels of about one value, made rising (isotonic regression, Ayer et al. 1955). Blocks that
// differ much more than most, such as those of an actor, hardly count. `usable`: [pixel], 0: not compared.
Rgb with_curve_of(const Rgb &plate, std::span<const std::uint8_t> usable, const Rgb &shown);

// The highlights that a plate clips, because a sensor and a file have a largest value. How bright they were is unknown.
// In a gathered picture, a pixel that a bright lamp covers in part is nearly as bright as the lamp. In a reduced plate,
// whose lamp is clipped, that pixel is grey, so discs, and with them the lens, would look smaller.

// Makes the clipped values of one channel of a plate brighter. Other values stay.
void raise_clipped(std::span<float> plane);

} // namespace sparselens
