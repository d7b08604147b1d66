// Finds what a ray meets in a scene, at the time of the ray.
#pragma once

#include "lab/trace/rigid_shapes.h"

#include <span>
#include <vector>

namespace sparselens::lab {

// Primitives are counted over what stands still, then over each moving body: quads first, then spheres.
class Tracer {
public:
    explicit Tracer(const Scene &scene); // keeps a copy

    const Scene &scene() const { return scene_; }
    Paint paint(const Hit &hit) const; // not for the sky

    // The nearest hit of each ray. Fastest for groups of 16 similar rays.
    void nearest(std::span<const Ray> rays, std::span<Hit> hits) const;

    // Whether anything is at t in (0, 1): for shadow rays that end at a light.
    void blocked(std::span<const Ray> rays, std::span<bool> blocked) const;

    // Every hit, in order of t; replaces the contents of `hits`.
    void all(const Ray &ray, std::vector<Hit> &hits) const;

private:
    struct Body {
        RigidShapes shapes;
        Motion motion;
        int first; // primitive
    };
    const Body &body_of(int primitive) const;

    Scene scene_;
    std::vector<Body> bodies_; // the first stands still
};

} // namespace sparselens::lab
