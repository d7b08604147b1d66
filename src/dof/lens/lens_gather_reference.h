// The lens gather, slow and obvious: for each pixel and each lens point, all samples of the LDI are tried. Tests
// the fast one.
//
// A lens point looks through one point of the pixel. It sees the samples whose unit square, displaced by their
// CoC, covers that point, front to back: coverage is taken for independent, and the first opaque one ends it.
// Inside `window` a pixel that lets light through to infinity has an opaque, colourless, transparent background
// there, and another one that moves with its last sample, behind everything. A lens point that meets nothing opaque
// does not know what lies behind: it counts by what it does know, which is the coverage that it met.
#pragma once

#include "base/image.h"
#include "deep/holdout.h"
#include "deep/ldi.h"
#include "lens/lens_samples.h"
#include "lens/thin_lens.h"

#include <span>

namespace sparselens {

// As lens_gather, with these lens points everywhere, without highlights and sharpening. Samples count as opaque
// at A = 1; ids are the front samples'.
Image lens_gather_reference(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                            std::span<const LensSample> points, const Holdout *holdout = nullptr);

} // namespace sparselens
