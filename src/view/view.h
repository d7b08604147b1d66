// A rendered picture with depth, and the position of its camera.
#pragma once

#include "../base/image.h"
#include "framing.h"

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace sparselens {

struct View {
    std::string name; // for messages
    Image image;      // R, G, B, A and further layers, premultiplied, without depth
    // The depth of each pixel: planar, measured from the camera of the centre view, in scene units, up to inf. A pixel
    // of depth 0 or less shows nothing, because it would lie behind that camera.
    std::vector<float> z;
    // The position of the camera relative to the centre view's: scene units, x right, y up, parallel axes.
    Imath::V2d position{0, 0};
    Framing framing = {};
};

} // namespace sparselens
