// Finds what a ray meets among shapes that do not move against each other. Embree finds the primitive; the position on
// it is then computed in double from the primitive itself, so that positions and depths are exact up to rounding and do
// not depend on the instruction set.
#pragma once

#include "lab/trace/scene.h"

#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace sparselens::lab {

// The points origin + t direction, t in (0, reach). Camera rays have direction.z = 1, so that t is planar depth.
struct Ray {
    Imath::V3d origin, direction;
    double time = 0.5; // of the shutter (motion.h)
};

struct Hit {
    double t = std::numeric_limits<double>::infinity();
    int primitive = -1; // -1: the sky
    double time = 0.5;
    Imath::V3d position;
    Imath::V3d at_rest; // the same point of the object before it moved, where its material is defined
    Imath::V3d normal;  // of unit length; on a sphere or quad it points to the side of the ray's start

    bool sky() const { return primitive < 0; }
};

class RigidShapes {
public:
    RigidShapes(const std::vector<Quad> &quads, const std::vector<Sphere> &spheres); // keeps copies
    ~RigidShapes();
    RigidShapes(RigidShapes &&) noexcept;
    RigidShapes &operator=(RigidShapes &&) noexcept;

    // Primitives are counted from 0: quads first, then spheres.
    int count() const;
    Material material(int primitive) const;

    // The nearest hit of each ray. Fastest for groups of 16 similar rays.
    void nearest(std::span<const Ray> rays, std::span<Hit> hits) const;

    // Whether anything is at t in (0, 1).
    void blocked(std::span<const Ray> rays, std::span<bool> blocked) const;

    // Appends every hit, in any order, some twice.
    void add_all(const Ray &ray, std::vector<Hit> &hits) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace sparselens::lab
