// Deep pictures, from the centre of the lens unless said otherwise, as other renderers in the literature produce them. Colours are
// premultiplied; the sky is a sample of alpha 1 at z = inf. The slabs of the scene follow as samples with Z and ZBack,
// whole and not tidied.
#pragma once

#include "deep/ldi.h"
#include "lab/trace/render.h"

namespace sparselens::lab {

// Depth peeling: the `layers` nearest surfaces along the ray through the centre of each pixel, including hidden ones.
// The depth of a surface is that at the pixel centre. Its colour and coverage are averages over those samples of the
// pixel that meet it, so textures are filtered and no sample mixes two surfaces.
Ldi render_peeled(const Tracer &tracer, const RenderSettings &settings, int layers, int samples,
                  std::uint32_t stream, Progress &progress);

// What the samples of each pixel see, as renderers write deep files: one sample for each surface that is visible in the
// pixel, at its mean depth, with the mean of its colours. What is hidden is not there. Coverages are those with which the
// surfaces, composited in the order of their depths, give the shares of the pixel that they take: flattened, this is the
// centre view. `u`: the lens point that it is seen from.
Ldi render_visible(const Tracer &tracer, const RenderSettings &settings, int samples, std::uint32_t stream,
                   Progress &progress, const Imath::V2d &u = {0, 0});

// The scene, cut by planes into `strata` depth intervals that are equal in perceptive depth from the nearest visible
// surface to infinity (the first one begins at the camera). Each is rendered as if the others did not exist, with a box
// filter and one depth per sample, at the pixel centre where the stratum has one. A surface that another surface of its
// own stratum hides is lost; one that another stratum hides is kept. In a pixel where a surface crosses from one
// stratum to the next, each stratum holds its share of the surface, and `over` lets a little of the background through
// between them: these are the known seams of such renderers.
Ldi render_strata(const Tracer &tracer, const RenderSettings &settings, int strata, int samples,
                  std::uint32_t stream, Progress &progress);

} // namespace sparselens::lab
