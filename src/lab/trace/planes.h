// The scene "planes" in closed form: rectangles that face the camera, textured with plane waves, so that what
// any filter makes of them can be calculated.
#pragma once

#include "lab/trace/scene.h"

#include <Imath/ImathBox.h>

#include <array>
#include <span>

namespace sparselens::lab {

// mean + amplitude sin(frequency . (x / z, y / z) + phase): the frequency counts radians per unit of slope, so
// that one of radians per pixel is it divided by the focal length in pixels. y up.
struct PlaneWave {
    double mean, amplitude;
    Imath::V2d frequency;
    double phase;
};

struct FacingPlane {
    double z;
    Imath::Box2d slopes;               // where it is: x / z and y / z
    std::array<PlaneWave, 3> radiance; // of R, G, B; it emits
};

// Nearest first; the last one fills the picture, and more.
std::span<const FacingPlane> facing_planes();

double radiance(const PlaneWave &wave, const Imath::V2d &slope);

Scene planes_scene(const Camera &camera);

} // namespace sparselens::lab
