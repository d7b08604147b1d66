// What makes a real lens's picture look like its own, beside the f-number and the focus.
#pragma once

#include "aperture_shape.h"

namespace sparselens {

struct LensLooks {
    ApertureShape aperture = {};
};

} // namespace sparselens
