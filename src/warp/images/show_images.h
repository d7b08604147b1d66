// Gives the samples of an LDI that show mirrors and glass the depth of what they show, and averages the views at that
// depth.
#pragma once

#include "warp/images/disagreement.h"
#include "warp/images/matched_view.h"

#include <span>

namespace sparselens {

// `ldi` is made of `views`, the centre view first; where the centre view shows one sample, it is the front sample of
// the LDI's pixel. `scale`: R F. `across`: pixels, across and down, that become one pixel of the picture. `differ`, by
// blocks of image_depths.h of the LDI's data window: where views differ by more than noise if the picture lies on the
// surface. Ldi::optical stays empty if no image is found.
void show_images(std::span<const PlacedView> views, double scale, int across,
                 std::span<const Disagreement> differ, Ldi &ldi);

} // namespace sparselens
