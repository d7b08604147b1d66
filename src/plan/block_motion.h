// How the surfaces in one picture have moved in another picture of the same scene: block matching.
//
// Both pictures are reduced to at most 480 pixels across. For the surface in the middle of each block of 8 x 8 such
// pixels, the displacement is found at which the second picture is most like it. A block does not count if it has no
// texture, if the second picture does not show it, or if it moves unlike the blocks around it. If several displacements
// are about equally good, as along an edge, the one closest to the expected displacement counts, so that no motion is
// made up.
#pragma once

#include "view/view.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <functional>
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

} // namespace sparselens
