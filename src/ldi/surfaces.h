// Which view samples in a pixel of the centre view show one surface.
#pragma once

#include "ldi/placed_views.h"

namespace sparselens {

struct Surface {
    std::vector<PlacedSample> samples; // the centre's first, if it shows the surface; never empty
    double inverse_z;                  // weighted mean

    bool seen_by_centre() const { return samples[0].view == 0; }
};

// Reused from pixel to pixel, so that nothing is allocated.
struct Surfaces {
    std::vector<Surface> list; // the first `count` are of the pixel, front to back
    std::size_t count = 0;

    std::span<const Surface> found() const { return std::span(list).first(count); }
};

// Two samples show one surface where their 1 / z differ by less than `tolerance` (inf: always). Samples in front of
// what the centre view shows, or where it shows that nothing is, do not belong to the pixel: only the rounding of
// their place brought them there. Reorders `samples`, which are those of one pixel.
void find_surfaces(const PlacedViews &views, double tolerance, std::span<PlacedSample> samples,
                   Surfaces &surfaces);

} // namespace sparselens
