// Cryptomattes through the lens (base/matte.h): which objects a lens sees in a pixel, and how much of each.
//
// The coverage of one id is gathered as the channel of a picture that shows this object in white and all others in
// black, through the same lens points as the picture itself; then the ids of each pixel are ranked anew.
#pragma once

#include "dof/lens/lens_gather.h"

namespace sparselens {

// Returns the mattes of the LDI in `window`; the channels are the LDI's matte channels. The arguments are those of
// lens_gather().
Image gather_mattes(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const LensGatherOptions &options, Progress &progress);

} // namespace sparselens
