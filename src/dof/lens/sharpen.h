// Undoes the blur that the gather itself adds to what is nearly in focus.
//
// A sample is the mean over a pixel; seen at a fraction f of a pixel off the grid, it is shared between two
// pixels, which blurs as interpolation does: along an axis a wave of frequency w keeps 1 - f (1 - f) (1 - cos w)
// of its square-mean amplitude. The mean of that over the lens is known from a sample's CoC and position, and
// subtracting as much of its second difference restores it to first order. What is strongly out of focus is left
// alone; so is what does not stand out of the noise around it.
#pragma once

#include "deep/ldi.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"
#include "lens/thin_lens.h"

namespace sparselens {

// Every channel of a sample is changed by the same weights (so that layers still add up to the beauty), chosen
// such that R, G and B do not become negative; what a sample gains its neighbours lose, so that light is kept.
// `colours` holds the colours of `samples` (sample_colours.h).
void sharpen_near_focus(const Ldi &ldi, const ThinLens &lens, const BlockedSamples &samples,
                        SampleColours &colours);

} // namespace sparselens
