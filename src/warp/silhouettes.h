// Pixels on a silhouette mix two surfaces under one depth; here they are taken apart again.
//
// Next to a jump of depth a pixel's colour is c = a F + (1 - a) B: F is what the nearer surface shows around it, B
// what the farther one does, a the share of the pixel that the nearer one covers (at most half where the pixel's
// own depth is the farther one, else at least half). Where c lies on the line from B to F, and F and B are far
// enough apart to tell, the pixel becomes two samples: c - (1 - a) B with coverage a in front, B behind. Flattened
// they are c again. B is a mean over the pixels around, or where c does not lie on that line one of the farther
// pixels beside it: a lamp half behind a post must not shine at the post's depth. Where that fails too the pixel is
// left as it is.
#pragma once

#include "deep/view_samples.h"

#include <cstddef>
#include <span>

namespace sparselens {

// `view` has at most one sample a pixel; scale is R F, pixels times scene units. jump, > 0: pixels of
// perceptive depth that part two surfaces. The same as where samples are averaged: what is mixed of two surfaces
// which are averaged apart would be left to one of them whole. The light of `crossed_lamps`, which are pixels in ascending
// order, stays theirs (lamps/lamp_depths.h).
void separate_silhouettes(ViewSamples &view, double scale, double jump,
                          std::span<const std::size_t> crossed_lamps = {});

} // namespace sparselens
