// Separates pixels on silhouettes, which mix two surfaces under one depth.
//
// Next to a jump of depth, a pixel's colour is c = a F + (1 - a) B. F is the colour of the nearer surface around the
// pixel, B the colour of the farther one, and a the share of the pixel that the nearer one covers (at most half if the
// pixel has the farther depth, else at least half). If c lies on the line from B to F, and F and B are far enough apart
// to tell, the pixel becomes two samples: c - (1 - a) B with coverage a in front, and B behind. Flattened, they are c
// again. B is a mean over the pixels around. If c does not lie on that line, B is one of the farther pixels beside it,
// because a lamp half behind a post must not shine at the post's depth. If that fails too, or if another view looks past
// the farther surface behind the nearer one, the pixel stays as it is.
//
// The farther surface may be a veil, such as smoke, a net or a see-through element. Then c = a F + (1 - a) k B over
// RGBA, where k says how dense the veil is in this pixel: coverage tells a and k apart.
#pragma once

#include "deep/view_samples.h"
#include "warp/matting/thin_structures.h"

#include <cstddef>
#include <span>

namespace sparselens {

// `view` has at most one sample per pixel. `scale` is R F, pixels times scene units. `jump`, > 0: two surfaces differ
// by at least this much in disparity, pixels. It must be the same as for averaging: otherwise a mixture of two
// surfaces that are averaged separately would be left whole to one of them. `crossed_lamps`: pixels, in ascending
// order, that keep their light (lamps/lamp_depths.h). `others`: the views that may show what is behind edges and strands.
void separate_silhouettes(ViewSamples &view, double scale, double jump,
                          std::span<const std::size_t> crossed_lamps = {},
                          const BackgroundFromViews *others = nullptr);

} // namespace sparselens
