// Turns the looks that a user, a lens file and a picture's header give into those of one lens and picture.
#pragma once

#include "../base/image.h"
#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "camera.h"
#include "look_values.h"

namespace sparselens {

// `lens` is the picture's lens (a proxy's has a shorter focal length in pixels). Throws UsageError if a look needs the
// focal length and it is unknown, or if the lens cannot focus that near.
LensLooks resolve_looks(const LookValues &values, const Camera &camera, const ThinLens &lens,
                        const Windows &windows);

} // namespace sparselens
