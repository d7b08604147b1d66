// How far beyond the frame the lens sees: what stands outside of the frame is blurred into it, but only if it was
// rendered.
//
// What stands there is not known, so it is taken to be as deep as what the frame shows at its border.
#pragma once

#include "../deep/ldi.h"
#include "../deep/packed_rows.h"
#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"

namespace sparselens {

// On the side where most is missing; where nothing is, on that which needs most.
struct BorderReach {
    int needed = 0;      // pixels of overscan: as far as light reaches across the border, rounded up
    int rendered = 0;    // pixels of overscan that the LDI has
    bool bright = false; // something at the border stands out so far that its disc would be seen
    bool too_little() const { return rendered < needed; }
};

// Of the samples of at least half coverage in the outermost pixels of the display window; 0 if the data window does not
// fill the display window, because then nothing was cut off. Light stands out if it is more than four times as bright
// as 31 of 32 samples of the border. How far it reaches is up to the looks too (lens/light_reach.h).
BorderReach border_reach(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks = {});

// The LDI of packed samples, of which only those pixels have any; or the outermost ones of another window.
Ldi border_of(const PackedRows &rows);
Ldi border_of(const PackedRows &rows, const Imath::Box2i &window);

} // namespace sparselens
