// Deep pictures as other renderers in the literature produce them, from the centre of the lens unless noted. Colours
// are premultiplied; the sky is a sample of alpha 1 at z = inf. The slabs of the scene follow as samples with Z and
// ZBack, whole and not tidied.
#pragma once

#include "deep/ldi.h"
#include "lab/trace/render.h"

namespace sparselens::lab {

// Depth peeling: the `layers` nearest surfaces along the ray through the centre of each pixel, including hidden ones.
// The depth of a surface is taken at the pixel centre. Its colour and coverage are averages over the samples of the
// pixel that meet it, so textures are filtered and no sample mixes two surfaces.
Ldi render_peeled(const Tracer &tracer, const RenderSettings &settings, int layers, int samples,
                  std::uint32_t stream, Progress &progress);

// Deep pictures as renderers write them: one sample for each surface that is visible in the pixel, at its mean depth,
// with its mean colour. Hidden surfaces are missing. The coverages are chosen so that the surfaces, composited in order
// of depth, give the shares of the pixel that they take: flattened, this is the centre view. `u`: the lens point of the
// view.
Ldi render_visible(const Tracer &tracer, const RenderSettings &settings, int samples, std::uint32_t stream,
                   Progress &progress, const Imath::V2d &u = {0, 0});

// The scene, cut by planes into `strata` depth intervals that are equal in disparity from the nearest visible
// surface to infinity (the first one begins at the camera). Each is rendered as if the others did not exist, with a box
// filter and one depth per sample, at the pixel centre if the stratum has a surface there. A surface hidden by another
// surface of its own stratum is lost; one hidden by another stratum is kept. In a pixel where a surface crosses from
// one stratum to the next, each stratum holds its share of the surface, and `over` lets a little of the background
// through between them: these are the known seams of such renderers.
Ldi render_strata(const Tracer &tracer, const RenderSettings &settings, int strata, int samples,
                  std::uint32_t stream, Progress &progress);

} // namespace sparselens::lab
