// Pictures of a scene: pinhole views from points of the lens, and the distributed-ray-tracing reference.
//
// Every result depends on the arguments alone, never on the number of threads.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "lab/trace/shading.h"
#include "lens/thin_lens.h"

#include <cstdint>
#include <span>

namespace sparselens::lab {

struct RenderSettings {
    Windows windows;
    ThinLens lens; // its focal length counts even where its radius is 0
    Light light = Light::sun;
    std::uint32_t seed = 0; // [0, 64): pictures of different seeds share no noise
    bool scattered = false; // views: no grids in the pixels, so that the average of many views is antialiased
};

// The stream of random numbers that `stream` is with these settings; `stream` is below 2^26.
inline std::uint32_t seeded(const RenderSettings &settings, std::uint32_t stream) {
    return stream + (settings.seed << 26);
}

// The ray from lens point `u` (unit disc) through position p of the picture (pixels, y down), parallel axes.
Ray view_ray(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p);

// The ray from lens point `u` to where the plane of focus is seen at p through the centre of the lens.
Ray lens_ray(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p);

// What a pinhole at lens point `u` sees: R G B A (half, box filter of one pixel) and Z (float, at the pixel
// centre). samples = n * n, not scattered: a regular n x n grid in each pixel; else low-discrepancy points.
// `stream` tells views apart, so that their noise is independent. `asked`: one value a pixel of the data window, those
// of 0 are not rendered and stay empty; none: all are.
Image render_view(const Tracer &tracer, const RenderSettings &settings, const Imath::V2d &u, int samples,
                  std::uint32_t stream, Progress &progress, std::span<const std::uint8_t> asked = {});

// Distributed ray tracing (R. Cook, T. Porter, L. Carpenter, 1984): `samples` rays a pixel, each from its own
// point of the lens through its own point of the pixel. R G B A, box filter of one pixel.
Image render_reference(const Tracer &tracer, const RenderSettings &settings, int samples, Progress &progress);

} // namespace sparselens::lab
