// The appearance of surfaces that camera rays hit, and the light that a ray returns.
#pragma once

#include "lab/trace/composite.h"
#include "lab/trace/tracer.h"

namespace sparselens::lab {

// sun: albedo (0.9 |n . l| + 0.15), without shadows. area: the first term comes from a square light and is estimated by
// one random point of the light and a shadow ray to it, which gives soft shadows and the noise of a path tracer. albedo
// and normal are a denoiser's inputs, by the same rays, mirrors and layers: albedo, the surface's colour, at most 1;
// normal, X, Y and Z as R, G and B, 0 for the sky.
enum class Light { sun, area, albedo, normal };

// The colour (not premultiplied) and coverage of each ray's hit. Mirrors and glass show what one bounce meets, or the
// ray that leaves the glass. `light_points`: one per hit, spread evenly over the unit square, for the point on the
// light and for the direction of rough reflections.
void shade(const Tracer &tracer, Light light, std::span<const Ray> rays, std::span<const Hit> hits,
           std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out);

// The premultiplied colour and alpha that each ray returns. `light_points` are one per ray. The rays of one call should
// be similar.
void trace_radiance(const Tracer &tracer, Light light, std::span<const Ray> rays,
                    std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out);

// Everything along a ray, visible or not, the sky last. Reused from ray to ray to avoid allocations.
struct LayerBuffers {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<Imath::V2d> light_points;
    std::vector<Imath::C4f> colours;
    std::vector<Layer> layers; // one per hit
};
void trace_layers(const Tracer &tracer, Light light, const Ray &ray, const Imath::V2d &light_point,
                  LayerBuffers &buffers);

// The single depth of a ray in a scene of partial coverage: the depth at which surfaces have covered half of the
// background. Slabs have no single depth and do not count.
double visible_depth(const Tracer &tracer, const Ray &ray);

} // namespace sparselens::lab
