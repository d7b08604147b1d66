// Turns the looks that a user, a lens file and a picture's header give into those of one lens and picture.
#pragma once

#include "../base/image.h"
#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "camera.h"
#include "look_values.h"

namespace sparselens {

// `lens` is that of the picture (a proxy's has a shorter focal length in pixels). UsageError: a look needs the focal
// length, which is unknown, or the lens cannot focus that near.
LensLooks resolve_looks(const LookValues &values, const Camera &camera, const ThinLens &lens,
                        const Windows &windows);

} // namespace sparselens
