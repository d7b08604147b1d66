// What a ray meets in a scene. Embree finds which primitive; where on it is solved again in double from the
// primitive itself, so that positions and depths are exact to rounding and depend on no instruction set.
#pragma once

#include "lab/trace/scene.h"

#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace sparselens::lab {

// Points origin + t direction, t in (0, reach). Camera rays have direction.z = 1, so that t is planar depth.
struct Ray {
    Imath::V3d origin, direction;
};

struct Hit {
    double t = std::numeric_limits<double>::infinity();
    int primitive = -1; // quads first, then spheres, in the scene's order; -1: the sky
    Imath::V3d position;
    Imath::V3d normal; // of unit length; out of a sphere, either way from a quad

    bool sky() const { return primitive < 0; }
};

class Tracer {
public:
    explicit Tracer(const Scene &scene); // keeps a copy
    ~Tracer();
    Tracer(Tracer &&) noexcept;
    Tracer &operator=(Tracer &&) noexcept;

    const Scene &scene() const;
    Material material(const Hit &hit) const; // not of the sky

    // The nearest hit of each ray. Fastest for runs of like rays, 16 or a multiple of it.
    void nearest(std::span<const Ray> rays, std::span<Hit> hits) const;

    // Whether anything lies at t in (0, 1): for shadow rays that end at a light.
    void blocked(std::span<const Ray> rays, std::span<bool> blocked) const;

    // Every hit, in order of t. What `hits` held is replaced.
    void all(const Ray &ray, std::vector<Hit> &hits) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace sparselens::lab
