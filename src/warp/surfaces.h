// Which view samples in a pixel of the centre view show one surface.
#pragma once

#include "warp/reprojected_views.h"

#include <span>
#include <vector>

namespace sparselens {

struct Surface {
    std::span<const ViewSample> samples; // the centre's first, if it shows the surface; never empty
    double inverse_z;                    // weighted mean

    bool seen_by_centre() const { return samples[0].view == 0; }
};

// Of some rows of the centre view.
struct Surfaces {
    std::vector<Surface> list;      // front to back within a pixel; refer to the rows' samples
    std::vector<std::size_t> begin; // pixel i, as in ReprojectedRows, has surfaces [begin[i], begin[i + 1])

    std::size_t pixels() const { return begin.size() - 1; }
    std::span<const Surface> pixel(std::size_t i) const {
        return std::span(list).subspan(begin[i], begin[i + 1] - begin[i]);
    }
};

// Two samples show one surface where their 1 / z differ by less than `tolerance` (inf: always). Samples in front of
// what the centre view shows, or where it shows that nothing is, do not belong to the pixel: only the rounding of
// their place brought them there. Reorders the samples of each pixel.
Surfaces find_surfaces(const ReprojectedViews &views, double tolerance, ReprojectedRows &rows);

} // namespace sparselens
