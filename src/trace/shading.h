// What the hits of camera rays look like, and what a ray brings back.
#pragma once

#include "trace/tracer.h"

namespace sparselens {

// sun: albedo (0.9 |n . l| + 0.15), no shadows. area: the same with l towards a random point of a square light,
// and the first term only where nothing blocks the way: one shadow ray a hit, noise as a path tracer's.
enum class Light { sun, area };

// Colour (not premultiplied) and coverage of each hit. light_points: one a hit, in the unit square, even over
// it; may be empty for the sun.
void shade(const Tracer &tracer, Light light, std::span<const Hit> hits,
           std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out);

// What each ray brings back: colour and alpha, premultiplied. Rays of one call should be alike.
void trace_radiance(const Tracer &tracer, Light light, std::span<const Ray> rays,
                    std::span<const Imath::V2d> light_points, std::span<Imath::C4f> out);

} // namespace sparselens
