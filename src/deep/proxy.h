// A small LDI that stands for a large one, for a quick look.
#pragma once

#include "ldi.h"

namespace sparselens {

// The pixels that hold those of `box` where `factor` of them, across and down, become one.
Imath::Box2i reduced(const Imath::Box2i &box, int factor);

// The LDI at 1 / factor of its size, >= 1. Samples of a pixel that lie within a hundredth of each other's depth are
// one surface: its coverage and colours are what the mean of the flattened pixels shows of it, so that flattening
// the small LDI gives the mean (box filter) of the flattened large one; its place is their mean. What they hide all
// of is kept behind it. Ids are those of the first sample of a surface. Data windows that are no multiple of `factor`
// are filled up with nothing. Without A it gets one.
Ldi proxy(const Ldi &ldi, int factor);

} // namespace sparselens
