// A rendered picture with depth, and where its camera stood.
#pragma once

#include "base/image.h"

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace sparselens {

struct View {
    std::string name;     // for messages
    Image image;          // what is carried: R, G, B, A and further layers, without depth; premultiplied
    std::vector<float> z; // planar depth of each pixel, scene units, (0, inf]
    // Of the camera, seen from the centre view's: scene units, x right, y up, axes parallel.
    Imath::V2d position{0, 0};
};

} // namespace sparselens
