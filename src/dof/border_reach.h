// How far beyond the frame the lens sees. Objects outside of the frame are blurred into it, but only if they were
// rendered. Their depth is not known, so it is taken to be that of the frame's border.
#pragma once

#include "../deep/ldi.h"
#include "../deep/packed_rows.h"
#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"

namespace sparselens {

// Describes the side where most is missing; if nothing is missing, the side that needs most.
struct BorderReach {
    int needed = 0;      // pixels of overscan: as far as light reaches across the border, rounded up
    int rendered = 0;    // pixels of overscan that the LDI has
    bool bright = false; // something at the border is so bright that its disc would show
    bool too_little() const { return rendered < needed; }
};

// Uses the samples of at least half coverage in the outermost pixels of the display window. The result is 0 if the data
// window does not fill the display window, because then nothing was cut off. Light stands out if it is more than four
// times as bright as 31 of 32 samples of the border. The looks also decide how far light reaches (lens/psf.h).
BorderReach border_reach(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks = {});

// How far the lens looks beyond the frame, in pixels across and down: as far as light of the outermost pixels reaches
// (lens/psf.h), rounded up to whole steps, so that small changes of focus gather the same samples; at most half of the
// frame's longer side. Only the outermost pixels of the LDI are needed.
Imath::V2i look_beyond(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                       const Imath::Box2i &frame);

// Returns an LDI with only the outermost pixels of the display window, or of `window`.
Ldi border_of(const PackedRows &rows);
Ldi border_of(const PackedRows &rows, const Imath::Box2i &window);

} // namespace sparselens
