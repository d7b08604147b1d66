#include "lab/trace/shading.h"

#include "lab/trace/composite.h"
#include "lab/trace/materials.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace sparselens::lab {

namespace {

constexpr std::size_t run_size = 64; // hits shaded at a time: they fit into the first-level cache

const Imath::V3d to_sun = Imath::V3d(0.4, 0.8, -0.5).normalized();

// The square light is at the sun's position as seen from the middle of the scenes, and faces them. It is so large that
// one random point of it tells little, and so bright that its pictures are about as bright as the sun's.
constexpr double light_distance = 12, light_side = 24, light_gain = 1.5;
const Imath::V3d light_centre = Imath::V3d(0, 0, 6) + light_distance * to_sun;
const Imath::V3d light_x = light_side * (to_sun % Imath::V3d(0, 0, 1)).normalized();
const Imath::V3d light_y = to_sun % light_x;

// `irradiance`: 1 if the sun is perpendicular to the surface.
Imath::C4f lit(const Paint &paint, double irradiance) {
    const float light = paint.emits ? 1.f : float(0.9 * irradiance + 0.15);
    return {paint.colour.x * light, paint.colour.y * light, paint.colour.z * light, paint.coverage};
}

void shade_by_sun(const Tracer &tracer, std::span<const Hit> hits, std::span<Imath::C4f> out) {
    const Imath::C3f &sky = tracer.scene().sky;
    const float sky_coverage = tracer.scene().sky_coverage;
    for (std::size_t i = 0; i < hits.size(); ++i)
        out[i] = hits[i].sky() ? Imath::C4f(sky.x, sky.y, sky.z, sky_coverage)
                               : lit(tracer.paint(hits[i]), std::abs(hits[i].normal ^ to_sun));
}

void shade_by_albedo(const Tracer &tracer, std::span<const Hit> hits, std::span<Imath::C4f> out) {
    const Paint sky{tracer.scene().sky, tracer.scene().sky_coverage, true};
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Paint paint = hits[i].sky() ? sky : tracer.paint(hits[i]);
        out[i] = {std::min(paint.colour.x, 1.f), std::min(paint.colour.y, 1.f), std::min(paint.colour.z, 1.f),
                  paint.coverage};
    }
}

void shade_by_normal(const Tracer &tracer, std::span<const Hit> hits, std::span<Imath::C4f> out) {
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].sky()) {
            out[i] = {0, 0, 0, tracer.scene().sky_coverage};
            continue;
        }
        const Imath::V3f normal(hits[i].normal);
        out[i] = {normal.x, normal.y, normal.z, tracer.paint(hits[i]).coverage};
    }
}

// From just above the surface, on the side of the light, to the light's point at t = 1.
Ray shadow_ray(const Hit &hit, const Imath::V2d &light_point) {
    const Imath::V3d target =
        light_centre + (light_point.x - 0.5) * light_x + (light_point.y - 0.5) * light_y;
    const double side = (hit.normal ^ (target - hit.position)) < 0 ? -1 : 1;
    const double clearance = 1e-5 * (1 + hit.position.length()); // several ulp of Embree's floats
    const Imath::V3d origin = hit.position + side * clearance * hit.normal;
    return {origin, target - origin, hit.time};
}

// Irradiance from the light's point at the end of a shadow ray, as if it were the whole light: it falls with slant and
// with the square of distance.
double irradiance(const Hit &hit, const Ray &shadow) {
    const double distance2 = shadow.direction.length2(), distance = std::sqrt(distance2);
    const double at_surface = std::abs(hit.normal ^ shadow.direction) / distance;
    const double at_light = std::max(0.0, to_sun ^ shadow.direction) / distance;
    return light_gain * at_surface * at_light * (light_distance * light_distance / distance2);
}

void shade_by_area(const Tracer &tracer, std::span<const Hit> hits, std::span<const Imath::V2d> light_points,
                   std::span<Imath::C4f> out) {
    assert(hits.size() <= run_size);
    std::array<Ray, run_size> rays;
    std::array<bool, run_size> blocked;
    std::array<std::size_t, run_size> owner;
    std::array<Paint, run_size> paints;
    std::size_t count = 0;
    const Paint sky{tracer.scene().sky, tracer.scene().sky_coverage, true};
    for (std::size_t i = 0; i < hits.size(); ++i) {
        paints[i] = hits[i].sky() ? sky : tracer.paint(hits[i]);
        out[i] = lit(paints[i], 0);
        if (paints[i].emits) continue;
        rays[count] = shadow_ray(hits[i], light_points[i]);
        owner[count++] = i;
    }
    tracer.blocked(std::span(rays).first(count), std::span(blocked).first(count));
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = owner[k];
        if (!blocked[k]) out[i] = lit(paints[i], irradiance(hits[i], rays[k]));
    }
}

void shade_surfaces(const Tracer &tracer, Light light, std::span<const Hit> hits,
                    std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out) {
    switch (light) {
    case Light::sun: return shade_by_sun(tracer, hits, out);
    case Light::albedo: return shade_by_albedo(tracer, hits, out);
    case Light::normal: return shade_by_normal(tracer, hits, out);
    case Light::area: break;
    }
    for (std::size_t first = 0; first < hits.size(); first += run_size) {
        const std::size_t n = std::min(run_size, hits.size() - first);
        shade_by_area(tracer, hits.subspan(first, n), light_points.subspan(first, n), out.subspan(first, n));
    }
}

// A direction that `point` of the unit square scatters evenly over a disc around `direction`.
Imath::V3d scattered(const Imath::V3d &direction, double rough, const Imath::V2d &point) {
    if (rough <= 0) return direction;
    const Imath::V3d axis = direction.normalized();
    const Imath::V3d aside = std::abs(axis.y) < 0.9 ? Imath::V3d(0, 1, 0) : Imath::V3d(1, 0, 0);
    const Imath::V3d x = (axis % aside).normalized(), y = axis % x;
    const double radius = rough * std::sqrt(point.x), angle = 2 * std::numbers::pi * point.y;
    return axis + radius * (std::cos(angle) * x + std::sin(angle) * y);
}

// A ray that leaves a slab of glass is parallel to the one that enters it (Snell's law, twice).
Ray through_glass(const Hit &hit, const Imath::V3d &in, double thickness) {
    const Imath::V3d axis = in.normalized();
    const Imath::V3d inward = ((axis ^ hit.normal) < 0 ? -1.0 : 1.0) * hit.normal;
    const Imath::V3d along =
        (axis - (axis ^ inward) * inward) / refractive_index; // along the surface; length: sine of the angle
    const double cosine = std::sqrt(1 - along.length2());
    const Imath::V3d leaves = hit.position + thickness * (inward + along / cosine);
    return {leaves + 1e-5 * (1 + leaves.length()) * in, in, hit.time};
}

Ray reflected(const Hit &hit, const Imath::V3d &in, double rough, const Imath::V2d &point) {
    const Imath::V3d direction = scattered(in - 2 * (in ^ hit.normal) * hit.normal, rough, point);
    return {hit.position + 1e-5 * (1 + hit.position.length()) * direction, direction, hit.time};
}

// One bounce: a mirror seen in a mirror shows its own colour.
void add_bounces(const Tracer &tracer, Light light, std::span<const Ray> rays, std::span<const Hit> hits,
                 std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out) {
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].sky()) continue;
        const Paint paint = tracer.paint(hits[i]);
        const float share = paint.mirror;
        if (share <= 0) continue;
        const Ray goes_on = paint.glass > 0
                                ? through_glass(hits[i], rays[i].direction, double(paint.glass))
                                : reflected(hits[i], rays[i].direction, double(paint.rough), light_points[i]);
        Hit seen;
        Imath::C4f colour;
        tracer.nearest({&goes_on, 1}, {&seen, 1});
        shade_surfaces(tracer, light, {&seen, 1}, {&light_points[i], 1}, {&colour, 1});
        out[i].r += share * (colour.r - out[i].r);
        out[i].g += share * (colour.g - out[i].g);
        out[i].b += share * (colour.b - out[i].b);
    }
}

// Every hit counts, because surfaces may be partial, and slabs may be between them.
void trace_through(const Tracer &tracer, Light light, std::span<const Ray> rays,
                   std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out) {
    LayerBuffers buffers;
    std::vector<Slab> slabs = tracer.scene().slabs;
    if (light == Light::normal)
        for (Slab &slab : slabs) slab.colour = {0, 0, 0};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        trace_layers(tracer, light, rays[i], light_points[i], buffers);
        out[i] = composite(buffers.layers, slabs);
    }
}

} // namespace

void shade(const Tracer &tracer, Light light, std::span<const Ray> rays, std::span<const Hit> hits,
           std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out) {
    shade_surfaces(tracer, light, hits, light_points, out);
    if (tracer.scene().mirrors) add_bounces(tracer, light, rays, hits, light_points, out);
}

void trace_layers(const Tracer &tracer, Light light, const Ray &ray, const Imath::V2d &light_point,
                  LayerBuffers &buffers) {
    auto &[rays, hits, light_points, colours, layers] = buffers;
    tracer.all(ray, hits);
    hits.emplace_back(); // the sky
    rays.assign(hits.size(), ray);
    light_points.assign(hits.size(), light_point);
    colours.resize(hits.size());
    shade(tracer, light, rays, hits, light_points, colours);
    layers.clear();
    for (std::size_t i = 0; i < hits.size(); ++i) layers.push_back({hits[i].t, colours[i]});
}

void trace_radiance(const Tracer &tracer, Light light, std::span<const Ray> rays,
                    std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out) {
    if (tracer.scene().translucent) return trace_through(tracer, light, rays, light_points, out);
    std::array<Hit, run_size> hits;
    for (std::size_t first = 0; first < rays.size(); first += run_size) {
        const std::size_t n = std::min(run_size, rays.size() - first);
        const auto some = std::span(hits).first(n);
        tracer.nearest(rays.subspan(first, n), some);
        shade(tracer, light, rays.subspan(first, n), some, light_points.subspan(first, n),
              out.subspan(first, n));
    }
}

double visible_depth(const Tracer &tracer, const Ray &ray) {
    std::vector<Hit> hits;
    tracer.all(ray, hits);
    double passes = 1;
    for (const Hit &hit : hits) {
        passes *= 1 - double(tracer.paint(hit).coverage);
        if (passes <= 0.5) return hit.t;
    }
    return std::numeric_limits<double>::infinity();
}

} // namespace sparselens::lab
