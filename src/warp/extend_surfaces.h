// Surfaces where no view could look: opaque ones are solid behind their samples, and those that something nearer
// hides continue behind it.
#pragma once

#include "base/grid.h"
#include "deep/ldi.h"
#include "warp/reprojected_views.h"

#include <Imath/ImathVec.h>

#include <optional>
#include <utility>
#include <vector>

namespace sparselens {

// How far views saw, the centre view first. `scale`: R F, above 0.
class Sights {
public:
    // Frees the samples of the views. Refers to their mappings.
    Sights(ReprojectedViews &views, double scale);

    // Whether no view saw through what has this disparity at a place of the centre view: each that looks there shows
    // something in front of it, nearer by this many pixels of disparity, in that pixel and in those around it, up to
    // WarpTuning::sight_margin. A pixel of a view that shows nothing was seen through.
    bool are_hidden(const Imath::V2d &place, double depth, double nearer) const;
    // By how much 1 / z differs in the centre view within a solid's reach of a place.
    double relief_at(const Imath::V2d &place) const { return double(relief_.at(place).value_or(0)); }

    const double scale;
    const Imath::Box2i frame; // of the centre view

private:
    // A value for each pixel of a view.
    struct OfPixels {
        Imath::Box2i display;
        Grid grid;
        std::vector<float> values;
        // Returns nothing where the view does not look, and 0 where it has no pixel, because it shows nothing there.
        std::optional<float> at(const Imath::V2d &place) const;
    };
    std::vector<std::pair<const ViewMapping *, OfPixels>> farthest_; // 1 / z
    OfPixels relief_;
};

// Continues surfaces behind nearer ones, where no view could look. Without these samples, a lens point between the
// views looks past an inner edge, and sees the sky or a lamp there.
//
// A surface that ends where nothing is nearer has an outer edge, and does not continue. A surface that ends where
// something nearer begins continues along its row or its column, as the mirror image of what it was before its end. The
// n-th pixel after the end lies as much nearer than the end as the n-th pixel before it lies farther, and its colour is
// the mean of these two pixels. The surface continues
// - for as many pixels as views saw of it before its end,
// - while no view saw through it, in this pixel or in those around it,
// - while something lies farther, or did at its end: fillers (dof/lens/fillers.h) continue the last layer,
// - while what hides it is nearer by more than (n - 1) / sqrt(2) pixels of disparity: no lens point looks farther
//   behind an edge, which may run at 45 degrees,
// - within the picture of the centre view.
// Surfaces that continue into a pixel from several sides at about the same depth become one sample: their mean, each
// weighted by 1 / n. Small lamps, mirrors, glass and volumes do not continue.

// Adds the samples to an LDI that is made of the views. Frees the memory of `sights` before it adds them.
void extend_surfaces(Sights &&sights, Ldi &ldi);

// Finds which opaque surfaces count as solid for some distance behind their samples (Ldi::solid), so that a lens point
// between the positions of the views does not look through a gap that no view saw open.
//
// The first sample of a pixel that covers half of it or more is WarpTuning::solid_px thick if no view saw through that
// thickness. If the surface is smooth within reach, no lens point can look past it, and it gets no solid. Mirrors and
// glass, which have the depth of images, are not solid.

// Sets Ldi::solid, which stays empty if nothing is solid. The LDI is made of the views.
void find_solids(const Sights &sights, Ldi &ldi);

} // namespace sparselens
