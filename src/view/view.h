// A rendered picture with depth, and where its camera stood.
#pragma once

#include "../base/image.h"
#include "framing.h"

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace sparselens {

struct View {
    std::string name; // for messages
    Image image;      // what is carried: R, G, B, A and further layers, without depth; premultiplied
    // Depth of each pixel: planar, from the centre view's camera on, scene units, up to inf. At 0 or less nothing is
    // shown: that lies behind the centre view's camera.
    std::vector<float> z;
    // Of the camera, seen from the centre view's: scene units, x right, y up, axes parallel.
    Imath::V2d position{0, 0};
    Framing framing = {};
};

} // namespace sparselens
