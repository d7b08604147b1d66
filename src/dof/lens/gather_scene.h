// All that the lens gather makes of an LDI for one lens and its looks before the first tile: what tiles are gathered from,
// one after the other, on the CPU and on a device.
#pragma once

#include "dof/facets/known_pixels.h"
#include "dof/facets/placed_facets.h"
#include "dof/lens/filler_samples.h"
#include "dof/lens/held_out.h"
#include "dof/lens/highlights.h"
#include "dof/lens/lens_gather.h"
#include "dof/lens/optics.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"

#include <memory>

namespace sparselens {

struct GatherScene {
    const Ldi *ldi;    // outlives this
    KnownPixels known; // of its pixels
    ThinLens lens;
    std::unique_ptr<const Optics> optics; // its parts refer to each other, wherever this is moved
    HeldOut held_out;                     // what stays sharp
    BlockedSamples samples;
    SampleColours colours; // less what highlights spread; none where nothing is out of focus
    Highlights highlights;
    FillerSamples fillers;
    PlacedFacets facets;
    BlockedSamples solids = {};             // place_solids()
    std::unique_ptr<const Ldi> coarse = {}; // of a coarse scene, its LDI, with no value but A

    // If pixels see through some lens points alone, else null.
    const CatEye *cat_eye() const { return optics->cat_eye.cuts() ? &optics->cat_eye : nullptr; }
    double pixel_aspect() const { return lens.pixel_aspect; }
};

// `coc` is added to that of all samples. Of the options: the looks, the holdout, and which pixels are known and were seen.
// The progress may end it between its steps.
GatherScene prepare(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const LensGatherOptions &options, double coc = 0, const Progress &progress = {});

// The same scene 1 / across as large, for tiles so far out of focus that they are gathered in cells of that many pixels, across
// and down (cells.h). It has no highlights, as their discs are exact, and nothing is sharpened. For scenes without a holdout.
GatherScene coarse_scene(const GatherScene &scene, int across);

} // namespace sparselens
