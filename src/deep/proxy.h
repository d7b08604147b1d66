// What part of the plane an LDI covers, and at which size.
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

namespace sparselens {

// The LDI with its data window grown to hold `data`; the new pixels are empty.
Ldi padded(Ldi ldi, const Imath::Box2i &data);

// How far the lens spreads its samples at most, pixels: the largest |c|, rounded up, across and down.
Imath::V2i largest_reach(const Ldi &ldi, const ThinLens &lens);

// The pixels that hold those of `box` where `factor` of them, across and down, become one.
Imath::Box2i reduced(const Imath::Box2i &box, int factor);

// The LDI at 1 / factor of its size, >= 1. Samples of a pixel that lie within a hundredth of each other's depth are
// one surface: its coverage and colours are what the mean of the flattened pixels shows of it, so that flattening
// the small LDI gives the mean (box filter) of the flattened large one; its place is their mean. What they hide all
// of is kept behind it. Ids are those of the first sample of a surface. Data windows that are no multiple of `factor`
// are filled up with nothing. Without A it gets one.
Ldi proxy(const Ldi &ldi, int factor);

} // namespace sparselens
