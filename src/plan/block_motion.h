// How the surfaces in one picture have moved in another picture of the same scene: block matching.
//
// Both pictures are reduced to at most 480 pixels across. For the surface in the middle of each block of 8 x 8 such
// pixels, the displacement is found at which the second picture is most like it. A block does not count if it has no
// texture, if the second picture does not show it, or if it moves unlike the blocks around it. If several displacements
// are about equally good, as along an edge, the one closest to the expected displacement counts, so that no motion is
// made up.
#pragma once

#include "lens/thin_lens.h"
#include "plan/plan.h"
#include "view/view.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <functional>
#include <optional>
#include <vector>

namespace sparselens {

struct BlockMotion {
    Imath::Box2i box;  // pixels of the first picture
    Imath::V2d motion; // pixels, x right, y down
};

// Where a static surface in this pixel of the first picture lies in the second one, relative to the pixel, in pixels:
// the camera's motion, or 0 if it is unknown.
using ExpectedMotion = std::function<Imath::V2d(const Imath::V2i &pixel)>;

// Returns the blocks that count, row by row. Only pixels that both pictures have are compared. Motion that differs from
// the expected one by more than a tenth of the width is not found.
std::vector<BlockMotion> block_motions(const View &first, const View &second, const ExpectedMotion &expected);

// How many moments of a shutter a picture with motion blur needs (docs/motion.md), from how far things move in it.
//
// Each moment leaves an image of what moves. The steps between these images do not show if they are short, and may be
// longer where the circle of confusion is large.

// The longest step between moments that does not show, in pixels, where the CoC has this radius in pixels.
double longest_step(double coc);

// `first` and `second` show the same scene at two times, which are `part` of the shutter's whole time apart, (0, 1]. A
// pixel of the picture has `across` x `across` of their pixels. Empty if they show nothing with texture, and so do not
// tell how far it moves.
std::optional<MomentsNeed> moments_needed(const View &first, const View &second, const ThinLens &lens,
                                          const ExpectedMotion &expected, double part, int across = 1);

} // namespace sparselens
