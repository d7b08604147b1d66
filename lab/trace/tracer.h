// Finds what a ray meets in a scene. Embree finds the primitive; the position on it is then computed in double from the
// primitive itself, so that positions and depths are exact up to rounding and do not depend on the instruction set.
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
};

struct Hit {
    double t = std::numeric_limits<double>::infinity();
    int primitive = -1; // quads first, then spheres, in the order of the scene; -1: the sky
    Imath::V3d position;
    Imath::V3d normal; // of unit length; on a sphere or quad it points to the side of the ray's start

    bool sky() const { return primitive < 0; }
};

class Tracer {
public:
    explicit Tracer(const Scene &scene); // keeps a copy
    ~Tracer();
    Tracer(Tracer &&) noexcept;
    Tracer &operator=(Tracer &&) noexcept;

    const Scene &scene() const;
    Material material(const Hit &hit) const; // not for the sky

    // The nearest hit of each ray. Fastest for groups of 16 similar rays.
    void nearest(std::span<const Ray> rays, std::span<Hit> hits) const;

    // Whether anything is at t in (0, 1): for shadow rays that end at a light.
    void blocked(std::span<const Ray> rays, std::span<bool> blocked) const;

    // Every hit, in order of t; replaces the contents of `hits`.
    void all(const Ray &ray, std::vector<Hit> &hits) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace sparselens::lab
