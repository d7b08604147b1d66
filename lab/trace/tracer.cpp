#include "lab/trace/tracer.h"

#include <algorithm>
#include <array>

namespace sparselens::lab {

namespace {

constexpr std::size_t run_size = 64; // rays moved at a time

// The ray as the body sees it at rest. Its parameter t stays the same.
Ray seen_at_rest(const Motion &motion, const Ray &ray) {
    const Placement placement(motion, ray.time);
    return {placement.point_at_rest(ray.origin), placement.direction_at_rest(ray.direction), ray.time};
}

// Calls visit(some rays as the body sees them, index of the first) for all rays.
template <typename Visit>
void for_runs(const Motion &motion, std::span<const Ray> rays, const Visit &visit) {
    std::array<Ray, run_size> moved;
    for (std::size_t first = 0; first < rays.size(); first += run_size) {
        const auto some = rays.subspan(first, std::min(run_size, rays.size() - first));
        std::ranges::transform(some, moved.begin(),
                               [&](const Ray &ray) { return seen_at_rest(motion, ray); });
        visit(std::span<const Ray>(moved).first(some.size()), first);
    }
}

// A hit on a body at rest becomes that on the moved body.
void move(Hit &hit, const Motion &motion, int first) {
    const Placement placement(motion, hit.time);
    hit.primitive += first;
    hit.position = placement.point(hit.at_rest);
    hit.normal = placement.direction(hit.normal);
}

} // namespace

Tracer::Tracer(const Scene &scene) : scene_(scene) {
    bodies_.push_back({RigidShapes(scene.quads, scene.spheres), {}, 0});
    for (const MovingBody &body : scene.bodies)
        bodies_.push_back({RigidShapes(body.quads, body.spheres), body.motion,
                           bodies_.back().first + bodies_.back().shapes.count()});
}

const Tracer::Body &Tracer::body_of(int primitive) const {
    return *std::ranges::find_if(bodies_.rbegin(), bodies_.rend(),
                                 [&](const Body &body) { return body.first <= primitive; });
}

Paint Tracer::paint(const Hit &hit) const {
    const Body &body = body_of(hit.primitive);
    return body.shapes.material(hit.primitive - body.first)(hit.at_rest);
}

void Tracer::nearest(std::span<const Ray> rays, std::span<Hit> hits) const {
    bodies_[0].shapes.nearest(rays, hits);
    std::array<Hit, run_size> found;
    for (const Body &body : std::span(bodies_).subspan(1))
        for_runs(body.motion, rays, [&](std::span<const Ray> some, std::size_t first) {
            body.shapes.nearest(some, found);
            for (std::size_t i = 0; i < some.size(); ++i) {
                if (!(found[i].t < hits[first + i].t)) continue;
                hits[first + i] = found[i];
                move(hits[first + i], body.motion, body.first);
            }
        });
}

void Tracer::blocked(std::span<const Ray> rays, std::span<bool> blocked) const {
    bodies_[0].shapes.blocked(rays, blocked);
    std::array<bool, run_size> found;
    for (const Body &body : std::span(bodies_).subspan(1))
        for_runs(body.motion, rays, [&](std::span<const Ray> some, std::size_t first) {
            body.shapes.blocked(some, found);
            for (std::size_t i = 0; i < some.size(); ++i) blocked[first + i] = blocked[first + i] || found[i];
        });
}

void Tracer::all(const Ray &ray, std::vector<Hit> &hits) const {
    hits.clear();
    bodies_[0].shapes.add_all(ray, hits);
    for (const Body &body : std::span(bodies_).subspan(1)) {
        const std::size_t before = hits.size();
        body.shapes.add_all(seen_at_rest(body.motion, ray), hits);
        for (Hit &hit : std::span(hits).subspan(before)) move(hit, body.motion, body.first);
    }
    std::sort(hits.begin(), hits.end(), [](const Hit &a, const Hit &b) {
        return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
    });
    std::erase_if(hits, [](const Hit &hit) { return !(hit.t > 0); });
    // A sphere is met twice, front and back, and both hits are solved for its front; a quad is met twice on its
    // diagonal.
    const auto same = [](const Hit &a, const Hit &b) { return a.primitive == b.primitive; };
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
}

} // namespace sparselens::lab
