// The data that the lens gather prepares from an LDI, for one lens and its looks, before the first tile. All tiles are
// gathered from it, on the CPU and on a device.
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

#include <algorithm>
#include <memory>

namespace sparselens {

struct GatherScene {
    const Ldi *ldi;    // must outlive this
    KnownPixels known; // of its pixels
    ThinLens lens;
    std::unique_ptr<const Optics> optics; // on the heap, because its parts refer to each other
    HeldOut held_out;                     // what stays sharp
    BlockedSamples samples;
    SampleColours colours; // without what highlights spread; empty if nothing is out of focus
    Highlights highlights;
    FillerSamples fillers;
    PlacedFacets facets;
    BlockedSamples solids = {};             // place_solids(); of one view: place_hiding_fillers()
    bool one_view = false;                  // then the solids are not seen: they only hide lamps
    std::unique_ptr<const Ldi> coarse = {}; // of a coarse scene: its LDI, with values of A alone

    // The cat-eye if pixels see through only some lens points, else null.
    const CatEye *cat_eye() const { return optics->cat_eye.cuts() ? &optics->cat_eye : nullptr; }
    double pixel_aspect() const { return lens.pixel_aspect; }
};

// `coc` is added to the CoC of all samples. Of the options, it uses the looks, the lens point, the holdout, and which
// pixels are known and were seen. The progress may end it between its steps.
GatherScene prepare(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const LensGatherOptions &options, double coc = 0, const Progress &progress = {});

// Adds the highlights of a picture to `lamps`. prepare() sharpens the colours first, so it may find slightly different
// ones.
void find_lamps(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                const LensGatherOptions &options, std::vector<LampPart> &lamps);

// Returns the scene at 1 / across of its size, for tiles so far out of focus that they are gathered in cells of
// `across` pixels, across and down (cells.h). It has no highlights, because their discs are exact, and nothing is
// sharpened. The scene must have no holdout.
GatherScene coarse_scene(const GatherScene &scene, int across);

// Calls visit(group) for the groups of moved highlights (highlight_groups.h) whose light may reach a tile. Its first
// pixel is `origin`, relative to the data window's corner.
template <typename Visit>
void for_each_moved(const GatherScene &scene, const Imath::V2i &origin, const Visit &visit) {
    const Imath::V2d half = scene.optics->aperture.half_extent();
    Imath::Box2f pixels(Imath::V2f(origin), Imath::V2f(origin + Imath::V2i(lens_tile_size)));
    if (scene.optics->field.skews()) pixels.makeInfinite(); // light may reach farther
    scene.highlights.groups.for_each_moved(pixels, std::max(half.x, half.y * scene.pixel_aspect()), visit);
}

} // namespace sparselens
