// Whether depths are planar, or linear in 1 / z: 1 / z itself, or a depth buffer's number from 0 to 1.
//
// On a plane 1 / z is linear across the picture. So in the middle between two pixels of one surface, z is the harmonic
// mean of their depths, and a depth that is linear in 1 / z is the plain mean.
#pragma once

#include "../../view/view.h"

#include <cstddef>

namespace sparselens {

struct DepthSlopes {
    std::size_t slopes = 0; // places where a surface recedes enough to tell
    double planar = 0;      // the share of them at the harmonic mean
    double inverse = 0;     // the share at the plain mean
};

DepthSlopes slopes_of_depth(const View &view);

// In 33 rendered and traced pictures, 0.82 to 1 of the slopes are planar and at most 0.02 inverse, except in one
// picture of round things alone, with 0.2 planar and 0.03 inverse. With 1 / z in place of z, 0.81 to 1 are inverse;
// only macro has 0.19, and is not noticed. False if there are too few slopes, because surfaces that face the camera do
// not recede.
bool looks_inverse(const DepthSlopes &slopes);

} // namespace sparselens
