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
#include "lens/aperture.h"
#include "lens/focus_field.h"
#include "lens/thin_lens.h"

#include <optional>

namespace sparselens {

// The lens's looks as far as they matter here: the shape of the aperture, how the CoC of a sample differs from that of a
// flat plane of focus (`coc` pixels and what the field says), and where the picture shows it. And the pixels that
// were seen (EXR coordinates): what is made up beyond them tells nothing of the noise; if none is given, all were.
struct SharpenLooks {
    const Aperture &aperture;
    const FocusField &field;
    double coc = 0;
    std::optional<Imath::Box2i> seen = {};
};

// Every channel of a sample is changed by the same weights (so that layers still add up to the beauty), chosen
// such that R, G and B do not become negative; what a sample gains its neighbours lose, so that light is kept.
// `colours` holds the colours of `samples` (sample_colours.h). What a cat-eye cuts is taken for open.
void sharpen_near_focus(const Ldi &ldi, const ThinLens &lens, const BlockedSamples &samples,
                        SampleColours &colours, const SharpenLooks *looks = nullptr);

} // namespace sparselens
