// The source of the effect with its depth, as a flat picture of dof-gather.
#pragma once

#include "asked.h"
#include "host_image.h"

#include <memory>

namespace sparselens_ofx {

struct FlatSource {
    std::shared_ptr<const FlatPicture> picture;
    bool unpremultiplied = false;
    Rectangle display; // the project, in the host's pixels
};

// Reads the clip Source and, if it is connected, the clip Depth, whose only component, or whose R, is the depth. The
// scale is that of the render. Throws HostError.
FlatSource flat_source(OfxImageEffectHandle effect, double time, double scale_x, double scale_y);

} // namespace sparselens_ofx
