// How many moments of a shutter a picture with motion blur needs (docs/motion.md), from how far things move in it.
//
// Each moment leaves an image of what moves. The steps between these images do not show if they are short, and may be
// longer where the circle of confusion is large.
#pragma once

#include "lens/thin_lens.h"
#include "plan/block_motion.h"
#include "plan/plan.h"
#include "view/view.h"

#include <optional>

namespace sparselens {

// The longest step between moments that does not show, in pixels, where the CoC has this radius in pixels.
double longest_step(double coc);

// `first` and `second` show the same scene at two times, which are `part` of the shutter's whole time apart, (0, 1]. A
// pixel of the picture has `across` x `across` of their pixels. Empty if they show nothing with texture, and so do not
// tell how far it moves.
std::optional<MomentsNeed> moments_needed(const View &first, const View &second, const ThinLens &lens,
                                          const ExpectedMotion &expected, double part, int across = 1);

} // namespace sparselens
