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
// - while what hides it is nearer by more than (n - 1) / sqrt(2) pixels of perceptive depth: no lens point looks farther
//   behind an edge, which may run at 45 degrees,
// - within the picture of the centre view.
// Surfaces that continue into a pixel from several sides at about the same depth become one sample: their mean, each
// weighted by 1 / n. Small lamps, mirrors, glass and volumes do not continue.
#pragma once

#include "deep/ldi.h"
#include "warp/images/matched_view.h"

#include <span>

namespace sparselens {

// Adds the samples to an LDI that is made of `views`, the centre view first. `scale`: R F, above 0.
void continue_surfaces(std::span<const PlacedView> views, double scale, Ldi &ldi);

} // namespace sparselens
