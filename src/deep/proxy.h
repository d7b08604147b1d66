// A small LDI that stands for a large one, for quick previews.
#pragma once

#include "ldi.h"

namespace sparselens {

// The pixels that contain those of `box` when `factor` of these, across and down, become one.
Imath::Box2i reduced(const Imath::Box2i &box, int factor);

// The LDI at 1 / factor of its size, factor >= 1. Samples of a pixel whose depths differ by at most a hundredth are one
// surface. Its coverage and colours are its share of the mean of the flattened pixels, so that the flattened small LDI
// is the mean (box filter) of the flattened large one; its position is their mean. Samples that they hide completely
// are kept behind it. Ids are those of the first sample of a surface. Data windows whose size is not a multiple of
// `factor` are filled up with empty pixels. The result has a channel A even if `ldi` has none.
Ldi proxy(const Ldi &ldi, int factor);

} // namespace sparselens
