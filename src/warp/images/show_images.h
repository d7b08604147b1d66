// Mirrors and glass in an LDI of views: the samples that show them get the depth of what they show, at which the views
// are averaged.
#pragma once

#include "warp/images/disagreement.h"
#include "warp/images/matched_view.h"

#include <span>

namespace sparselens {

// The LDI is made of the views, the first of which is the centre; where that shows one sample, it is the front one of the
// LDI's pixel. `scale` is R F; `across` pixels, across and down, become
// one of the picture. `differ`, by blocks of image_depths.h of the LDI's data window: where views differ by
// more than noise if the picture lies on the surface. Ldi::optical stays empty if no image is found.
void show_images(std::span<const PlacedView> views, double scale, int across,
                 std::span<const Disagreement> differ, Ldi &ldi);

} // namespace sparselens
