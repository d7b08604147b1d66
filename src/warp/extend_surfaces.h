// Surfaces where no view could look: opaque ones are solid behind their samples, and those that something nearer
// hides continue behind it.
#pragma once

#include "base/grid.h"
#include "deep/ldi.h"
#include "deep/view_samples.h"
#include "warp/images/matched_view.h"

#include <Imath/ImathVec.h>

#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace sparselens {

// Continues surfaces behind nearer ones, where no view could look. Without these samples, a lens point between the views
// looks past an inner edge, and sees the sky or a lamp there.
//
// A surface that ends where nothing is nearer has an outer edge, and does not continue. A surface that ends where
// something nearer begins continues along its row or its column, as the mirror image of what it was before its end. The
// n-th pixel after the end lies as much nearer than the end as the n-th pixel before it lies farther, and its colour is
// the mean of these two pixels. The surface continues
// - for as many pixels as views saw of it before its end,
// - while no view saw through it, in this pixel or in those around it,
// - while something lies farther: where nothing does, fillers (dof/lens/fillers.h) do as well,
// - while what hides it is nearer by more than (n - 1) / sqrt(2) pixels of disparity: no lens point looks farther
//   behind an edge, which may run at 45 degrees,
// - within the picture of the centre view.
// Surfaces that continue into a pixel from several sides at about the same depth become one sample: their mean, each
// weighted by 1 / n. Small lamps, mirrors, glass and volumes do not continue.

// Adds the samples to an LDI that is made of `views`, the centre view first. `scale`: R F, above 0.
void extend_surfaces(std::span<const PlacedView> views, double scale, Ldi &ldi);

// Finds which opaque surfaces count as solid for some distance behind their samples (Ldi::solid), so that a lens point
// between the positions of the views does not look through a gap that no view saw open.
//
// The first sample of a pixel that covers half of it or more is WarpTuning::solid_px thick if no view saw through that
// thickness: every view that looks at the position this much farther away has something nearer there, and in the pixels
// around. If the surface is smooth within reach, no lens point can look past it, and it gets no solid. A pixel of a
// view that shows nothing counts as seen through. Mirrors and glass, which have the depth of images, are not solid.

// Sets Ldi::solid, which stays empty if nothing is solid. `ldi` is made of `views`, the centre view first. `scale`: R
// F, above 0.
void find_solids(std::span<const PlacedView> views, double scale, Ldi &ldi);

// 1 / z of the farthest thing that each pixel of a view shows; 0: it lets light through to infinity.
std::vector<float> farthest_in(const ViewSamples &view);

// The least value in a square around each pixel.
std::vector<float> least_around(const std::vector<float> &values, const Grid &grid, int radius);

// Looks up values of a view by position.
class FarthestDepth {
public:
    FarthestDepth(const ViewSamples &view, std::vector<float> values)
        : display_(view.windows.display), grid_(view.windows.data), values_(std::move(values)) {}

    // Returns nothing where the view does not look, and 0 where it has no pixel, because it shows nothing there.
    std::optional<float> at(const Imath::V2d &place) const {
        if (!(std::abs(place.x) < 1e9 && std::abs(place.y) < 1e9)) return {};
        const Imath::V2i pixel(int(std::floor(place.x)), int(std::floor(place.y)));
        if (grid_.contains(pixel.x, pixel.y)) return values_[grid_.index(pixel.x, pixel.y)];
        return display_.intersects(pixel) ? std::optional(0.0f) : std::nullopt;
    }

private:
    Imath::Box2i display_;
    Grid grid_;
    std::vector<float> values_;
};

// 1 / z of the farthest thing in a pixel of the view and in those around it, up to WarpTuning::sight_margin.
FarthestDepth farthest_around(const ViewSamples &view, const std::vector<float> &farthest);

} // namespace sparselens
