// Undoes the blur that the gather itself adds to what is nearly in focus.
//
// A sample is the mean over a pixel; seen at a fraction f of a pixel off the grid, it is shared between two pixels,
// which blurs as interpolation does: along an axis a wave of frequency w keeps 1 - f (1 - f) (1 - cos w) of its
// square-mean amplitude. The mean of f (1 - f) over the lens is known from a sample's CoC and position; subtracting
// half of it times the second difference restores the wave to first order. Samples far out of focus are left alone, and
// so is detail that does not stand out of the noise around it.
#pragma once

#include "deep/ldi.h"
#include "dof/lens/sample_blocks.h"
#include "lens/aperture.h"
#include "lens/focus_field.h"
#include "lens/thin_lens.h"

#include <optional>

namespace sparselens {

// The lens's looks as far as they matter here: the shape of the aperture, how the CoC of a sample differs from the CoC
// for a flat plane of focus (by `coc` pixels, and by the field), and where the picture shows the sample. `seen`: the
// pixels that were seen (EXR coordinates); pixels made up beyond them tell nothing of the noise. Not set: all pixels
// were seen.
struct SharpenLooks {
    const Aperture &aperture;
    const FocusField &field;
    double coc = 0;
    std::optional<Imath::Box2i> seen = {};
};

// Every channel of a sample is changed by the same weights (so that layers still add up to the beauty), chosen such
// that R, G and B do not become negative. Its neighbours lose what a sample gains, so that light is kept. `colours`
// holds the colours of `samples` (sample_blocks.h). The part of the lens that a cat-eye cuts counts as open.
void sharpen_near_focus(const Ldi &ldi, const ThinLens &lens, const BlockedSamples &samples,
                        SampleColours &colours, const SharpenLooks *looks = nullptr);

} // namespace sparselens
