// What the hits of camera rays look like, and what a ray brings back.
#pragma once

#include "lab/trace/composite.h"
#include "lab/trace/tracer.h"

namespace sparselens::lab {

// sun: albedo (0.9 |n . l| + 0.15), no shadows. area: the first term comes from a square light, estimated by one
// random point of it and a shadow ray to there: soft shadows, and noise as a path tracer's.
enum class Light { sun, area };

// Colour (not premultiplied) and coverage of what each ray hits; mirrors show one bounce. light_points: one a hit,
// in the unit square, even over it; the sun does not look at them.
void shade(const Tracer &tracer, Light light, std::span<const Ray> rays, std::span<const Hit> hits,
           std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out);

// What each ray brings back: colour and alpha, premultiplied. light_points: one a ray. Rays of one call should
// be alike.
void trace_radiance(const Tracer &tracer, Light light, std::span<const Ray> rays,
                    std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out);

// Everything along a ray, visible or not, the sky last; kept from ray to ray to spare allocations.
struct LayerBuffers {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<Imath::V2d> light_points;
    std::vector<Imath::C4f> colours;
    std::vector<Layer> layers; // one a hit
};
void trace_layers(const Tracer &tracer, Light light, const Ray &ray, const Imath::V2d &light_point,
                  LayerBuffers &buffers);

// The one depth of a ray in a scene of partial coverage: where surfaces have covered half of what lies behind.
// Slabs have no one depth and do not count.
double visible_depth(const Tracer &tracer, const Ray &ray);

} // namespace sparselens::lab
