// The scene "planes" in closed form: rectangles that face the camera, textured with plane waves, so that the result of
// any filter can be calculated.
#pragma once

#include "lab/trace/scene.h"

#include <Imath/ImathBox.h>

#include <array>
#include <span>

namespace sparselens::lab {

// mean + amplitude sin(frequency . (x / z, y / z) + phase), y up. The frequency is in radians per unit of slope;
// divided by the focal length in pixels it is in radians per pixel.
struct PlaneWave {
    double mean, amplitude;
    Imath::V2d frequency;
    double phase;
};

struct FacingPlane {
    double z;
    Imath::Box2d slopes;               // its extent in x / z and y / z
    std::array<PlaneWave, 3> radiance; // of R, G and B; the plane emits
};

// Sorted nearest first; the last one fills more than the picture.
std::span<const FacingPlane> facing_planes();

double radiance(const PlaneWave &wave, const Imath::V2d &slope);

Scene planes_scene(const Camera &camera);

} // namespace sparselens::lab
