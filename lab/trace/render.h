// Pictures of a scene: pinhole views from points of the lens, and the reference by distributed ray tracing.
//
// Every result depends only on the arguments, never on the number of threads.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "deep/recolor.h"
#include "lab/trace/shading.h"
#include "lens/lens_looks.h"
#include "lens/thin_lens.h"

#include <cstdint>
#include <span>

namespace sparselens::lab {

struct RenderSettings {
    Windows windows;
    ThinLens lens; // its focal length is used even if its radius is 0
    Light light = Light::sun;
    Motion camera = {};            // of the camera, in world space, which is its space at rest
    Exposure exposure = {};        // depths are those in the middle of it
    double rolling = 1;            // the duration of a rolling shutter (shutter/shutter_mean.h)
    std::uint32_t seed = 0;        // [0, 64): pictures of different seeds share no noise
    std::uint32_t stream = 0;      // of the reference, below 2^26: different streams share no noise
    LensLooks looks = {};          // of the reference
    HighlightGain highlights = {}; // gain for the light of its rays
    bool scattered = false;        // views: no grids in pixels, so that the mean of many views is antialiased
};

// When row y of the picture is exposed.
Exposure exposure_of_row(const RenderSettings &settings, int y);

// The stream of random numbers for `stream` (below 2^26) with these settings.
inline std::uint32_t seeded(const RenderSettings &settings, std::uint32_t stream) {
    return stream + (settings.seed << 26);
}

// The ray of the camera at rest, where it stands at the ray's time.
Ray from_camera(const RenderSettings &settings, const Ray &at_rest);

// The ray from lens point `u` (unit disc) through position p of the picture (pixels, y down), with parallel axes.
Ray view_ray(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p, double time);
inline Ray view_ray(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p) {
    return view_ray(settings, u, p, settings.exposure.middle());
}
// The same for the camera at rest.
Ray view_ray_at_rest(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p, double time);

// The ray from lens point `u` to the point of the focus plane that is seen at p through the centre of the lens.
Ray lens_ray(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p, double time);
inline Ray lens_ray(const RenderSettings &settings, const Imath::V2d &u, const Imath::V2d &p) {
    return lens_ray(settings, u, p, settings.exposure.middle());
}

// The picture through a pinhole at lens point `u`: R G B A (half, box filter of one pixel) and Z (float, at the pixel
// centre). With samples = n * n, not scattered, each pixel has a regular n x n grid; else the points have low
// discrepancy. `stream` distinguishes views, so that their noise is independent. `asked` holds one value per pixel of
// the data window: pixels of value 0 are not rendered and stay empty. If `asked` is empty, all pixels are rendered.
Image render_view(const Tracer &tracer, const RenderSettings &settings, const Imath::V2d &u, int samples,
                  std::uint32_t stream, Progress &progress, std::span<const std::uint8_t> asked = {});

// Distributed ray tracing (R. Cook, T. Porter, L. Carpenter, 1984): `samples` rays per pixel, each from its own point
// of the lens through its own point of the pixel. R G B A, with a box filter of one pixel. The lens has the looks of
// settings.looks.
Image render_reference(const Tracer &tracer, const RenderSettings &settings, int samples, Progress &progress);

} // namespace sparselens::lab
