// What a test scene is made of: a handful of primitives with procedural materials, before a camera at the
// origin that looks along +z with y up (x right). Lengths are scene units, light is scene-linear.
#pragma once

#include "view/camera.h"

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <array>
#include <vector>

namespace sparselens::lab {

// What a material says of one of its points.
struct Paint {
    Imath::C3f colour;  // albedo, [0, 1]; radiance where it emits; not premultiplied
    float coverage = 1; // share of what lies behind that it hides, [0, 1]
    bool emits = false; // neither sun nor lamp changes it
    float mirror = 0;   // share of the light that a perfect mirror sends instead of the colour, [0, 1]
};

using Material = Paint (*)(const Imath::V3d &position);

struct Quad {
    std::array<Imath::V3d, 4> corners; // in order around it, in one plane
    Material material;
};

// Its outside is visible, its inside is not.
struct Sphere {
    Imath::V3d centre;
    double radius;
    Material material;
};

// A homogeneous volume between two planes that face the camera. A ray that crosses it from z0 to z1 loses
// 1 - exp(-density (z1 - z0)) of what comes from behind, whatever its slant: optical depth counts planar depth,
// so one deep sample with Z and ZBack holds it exactly, for every lens point.
struct Slab {
    double z_front, z_back;
    double density;    // optical depth per scene unit of planar z
    Imath::C3f colour; // radiance of the slab were it opaque
};

struct Scene {
    std::vector<Quad> quads;
    std::vector<Sphere> spheres;
    std::vector<Slab> slabs;
    bool mirrors = false;     // a material reflects: every hit has to be asked
    bool translucent = false; // slabs, or coverage below 1: a ray has to composite every hit
    Imath::C3f sky{0, 0, 0};  // radiance of what hits nothing; alpha 1, at z = inf
    Camera camera;            // its default lens: focal length, film back, f-number, focus, scene unit
};

} // namespace sparselens::lab
