// The elements of a test scene: a few primitives with procedural materials in front of a camera at the origin, which
// looks along +z with x right and y up. Lengths are in scene units; light is scene-linear.
#pragma once

#include "lab/trace/motion.h"
#include "view/view.h"

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

#include <array>
#include <vector>

namespace sparselens::lab {

// The material at one of its points.
struct Paint {
    Imath::C3f colour;  // albedo, [0, 1], or radiance if it emits; not premultiplied
    float coverage = 1; // share of the background that it hides, [0, 1]
    bool emits = false; // radiance that does not depend on the sun and the light
    float mirror = 0;   // share of a mirror, or of glass, instead of the colour, [0, 1]
    float rough = 0;    // scatter of the mirror: the tangent of the largest angle to the perfect reflection
    float glass =
        0; // above 0: not a mirror but a plane-parallel slab of glass of this thickness behind the surface
};

using Material = Paint (*)(const Imath::V3d &position);

struct Quad {
    std::array<Imath::V3d, 4> corners; // in order, in one plane
    Material material;
};

// Visible from both sides: a ray from outside meets the nearer side, one from inside the farther side.
struct Sphere {
    Imath::V3d centre;
    double radius;
    Material material;
};

// An object that moves while the shutter is open, as it stands at rest. Its materials move with it.
struct MovingBody {
    std::vector<Quad> quads;
    std::vector<Sphere> spheres;
    Motion motion;
};

// A homogeneous volume between two planes that face the camera. A ray that crosses it from z0 to z1 loses 1 -
// exp(-density (z1 - z0)) of the light from behind, whatever its slant: optical depth is proportional to planar depth,
// so one deep sample with Z and ZBack describes the slab exactly for every lens point.
struct Slab {
    double z_front, z_back;
    double density;    // optical depth per scene unit of planar z
    Imath::C3f colour; // radiance of the slab if it were opaque
};

struct Scene {
    std::vector<Quad> quads;
    std::vector<Sphere> spheres;
    std::vector<MovingBody> bodies;
    std::vector<Slab> slabs;  // they move with the camera
    bool mirrors = false;     // some material reflects, so every hit is checked
    bool translucent = false; // there are slabs, or coverage below 1: rays composite every hit
    Imath::C3f sky{0, 0, 0};  // radiance of rays without a hit; z = inf
    float sky_coverage = 1;   // their alpha: 1, or 0 if there is no sky
    Motion camera_motion;
    Camera camera; // the default lens: focal length, sensor width, f-number, focus, scene unit
};

} // namespace sparselens::lab
