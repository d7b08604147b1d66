// A slow and simple ray tracer to test the fast one: every primitive, in double, by textbook formulas.
#pragma once

#include "lab/trace/tracer.h"

#include <algorithm>
#include <cmath>

namespace sparselens::lab {

// Ray parameter of the nearest point on the sphere's outside, or inf.
inline double sphere_hit(const Sphere &sphere, const Ray &ray) {
    const Imath::V3d to_ray = ray.origin - sphere.centre;
    const double a = ray.direction ^ ray.direction, b = 2 * (to_ray ^ ray.direction);
    const double c = (to_ray ^ to_ray) - sphere.radius * sphere.radius;
    const double discriminant = b * b - 4 * a * c;
    const double t = discriminant < 0 ? -1 : (-b - std::sqrt(discriminant)) / (2 * a);
    return t > 0 ? t : std::numeric_limits<double>::infinity();
}

inline double quad_hit(const Quad &quad, const Ray &ray) {
    const auto &c = quad.corners;
    const Imath::V3d normal = (c[1] - c[0]) % (c[3] - c[0]);
    const double t = ((c[0] - ray.origin) ^ normal) / (ray.direction ^ normal);
    const Imath::V3d p = ray.origin + t * ray.direction;
    for (std::size_t i = 0; i < 4; ++i) // inside all edges
        if ((((c[(i + 1) % 4] - c[i]) % (p - c[i])) ^ normal) < 0)
            return std::numeric_limits<double>::infinity();
    return t > 0 ? t : std::numeric_limits<double>::infinity();
}

struct SlowHit {
    double t;
    int primitive;
};

// The body where it stands at that time: it moves, not the ray.
inline MovingBody placed(MovingBody body, double time) {
    const Placement placement(body.motion, time);
    for (Quad &quad : body.quads)
        for (Imath::V3d &corner : quad.corners) corner = placement.point(corner);
    for (Sphere &sphere : body.spheres) sphere.centre = placement.point(sphere.centre);
    return body;
}

inline std::vector<SlowHit> all_hits(const Scene &scene, const Ray &ray) {
    std::vector<SlowHit> hits;
    const auto add = [&](const std::vector<Quad> &quads, const std::vector<Sphere> &spheres) {
        for (const Quad &quad : quads) hits.push_back({quad_hit(quad, ray), int(hits.size())});
        for (const Sphere &sphere : spheres) hits.push_back({sphere_hit(sphere, ray), int(hits.size())});
    };
    add(scene.quads, scene.spheres);
    for (const MovingBody &body : scene.bodies) {
        const MovingBody there = placed(body, ray.time);
        add(there.quads, there.spheres);
    }
    std::erase_if(hits, [](const SlowHit &hit) { return std::isinf(hit.t); });
    std::sort(hits.begin(), hits.end(), [](const SlowHit &a, const SlowHit &b) { return a.t < b.t; });
    return hits;
}

} // namespace sparselens::lab
