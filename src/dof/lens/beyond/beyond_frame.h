// What lies beyond the frame, the window of which everything is known: what leaves the frame goes on beyond it as it leaves,
// and what enters nothing stays nothing.
//
// A pixel beyond the frame continues the pixel of the frame that is nearest to it: it has its samples, with their coverage,
// depth and place in the pixel, and lets light through to infinity if that does. Across a side beyond which there are samples,
// rim views looked past the frame, by the perceptive depth of what they saw: n pixels from the frame, what is nearer than
// n - 1/2 pixels is there or not, as they showed it. There a sample goes on from the last pixel in which they could see it, or
// from the last but one, if they saw nothing of its surface in the last, where parallax may tear it. So what they saw to end
// ends, and what only they saw goes on too. Past corners lies what goes on both above or below the frame and beside it. Where
// that leaves out what ends the frame's pixel, it is unknown what lies there.
//
// Across other sides, an opaque surface in front ends where others do: those that the row shows whole within 96 pixels, nearer
// than what is on either side of them, as near as it (one_surface_px) and at most one pixel narrower. It becomes as wide as the
// narrowest of them; past that goes on what lies beside it in the frame. If there are none, it goes on.
//
// A small light goes on as a disc does, so that a lamp leaves no streak. It is one where it is brighter than four times what
// four of five pixels up to 32 away along the border stay below. How wide it is where it was seen last, and 2 pixels before
// (1, where it was not that long), says how far its disc reaches on; n times as far, 1 / n^2 of its light is left.
#pragma once

#include "deep/ldi.h"
#include "lens/lens_looks.h"
#include "lens/thin_lens.h"

#include <vector>

namespace sparselens {

struct BeyondFrame {
    Ldi ldi; // its data window grown by whole cells of 32 pixels, so that samples are kept in the same blocks
    Imath::Box2i known;       // the pixels of which the empty ones are transparent to infinity, but for
    std::vector<char> unseen; // [pixel of the data window]
};

// How far the lens looks beyond the frame, in pixels across and down: as far as light of its outermost pixels reaches
// (lens/light_reach.h), which is all that is needed of the LDI; and at most by half of its longer side.
Imath::V2i look_beyond(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                       const Imath::Box2i &frame);

// `known`: the part of the frame whose samples the LDI has, rows of it; beyond those at its border, it goes on. `across`: pixels,
// across and down, that become one of the picture: distances above are counted in those, but for what rim views saw.
// `views_radius`: scene units, of the lens from whose rim they looked, in whose pixels perceptive depth says what they saw; 0: of
// this lens.
BeyondFrame go_on_beyond(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                         const Imath::Box2i &frame, const Imath::Box2i &known, const Imath::V2i &reach,
                         int across = 1, double views_radius = 0);
BeyondFrame go_on_beyond(Ldi &&ldi, const ThinLens &lens, const LensLooks &looks, const Imath::Box2i &frame,
                         const Imath::Box2i &known, const Imath::V2i &reach, int across = 1,
                         double views_radius = 0);

} // namespace sparselens
