// Deep pictures from the centre of the lens, as other renderers of the literature deliver them. Colours are
// premultiplied; the sky is a sample of alpha 1 at z = inf. A scene's slabs follow as samples with Z and ZBack,
// whole and untidied.
#pragma once

#include "deep/ldi.h"
#include "lab/trace/render.h"

namespace sparselens::lab {

// Depth peeling: the `layers` nearest surfaces along the ray through each pixel's centre, hidden ones too.
// Where a surface is peeled is decided at the pixel centre; its colour and coverage are averaged over those of
// the pixel's samples that meet it, so textures are filtered and no sample mixes two surfaces.
Ldi render_peeled(const Tracer &tracer, const RenderSettings &settings, int layers, int samples,
                  std::uint32_t stream, Progress &progress);

// The scene cut by planes into `strata` depth intervals, equal in perceptive depth from the nearest visible
// surface to infinity (the first one begins at the camera); each is rendered as if the others were not there, box
// filter, one depth a sample, at the pixel centre where the stratum has one. What lies behind another surface of
// its own stratum is lost; what another stratum hides is there, wherever the rays of the centre go. In a pixel
// where a surface crosses from one stratum to the next each holds its share of it, and `over` lets a little of the
// background through between them: the known seams of such renderers.
Ldi render_strata(const Tracer &tracer, const RenderSettings &settings, int strata, int samples,
                  std::uint32_t stream, Progress &progress);

} // namespace sparselens::lab
