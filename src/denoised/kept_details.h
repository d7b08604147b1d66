// Which of the details that a denoiser took from views are no noise.
//
// Noise of one view is independent of that of another. A detail is on a surface, so all views that see the surface show it. Let
// R be the noisy view less the denoised one, averaged over 3 x 3 pixels. Over a window, the mean of the products of R in two
// views is what the views share, b^2; half of the mean squared difference is the noise, s^2. The best share of R to keep is
// b^2 / (b^2 + s^2) (N. Wiener, 1949). A small lamp is one pixel of a window: it is kept as far as the mean of R over the views
// stands out from the noise there (W. James, C. Stein, 1961), which is told by geometric means, because lamps of other surfaces
// are outliers among the differences; views must agree on the lamp, as they do not on a firefly.
#pragma once

#include "base/grid.h"
#include "finish/colours.h"
#include "view/view_mapping.h"

#include <span>
#include <vector>

namespace sparselens {

// One layer of a view, pixel by pixel of `grid`.
struct DenoisedLayer {
    Grid grid;                // EXR coordinates
    std::span<const float> z; // planar depth; 0 or less shows nothing
    ViewMapping mapping;      // to the centre view
    Colours noisy, denoised;  // the same channels
};

// What the noisy view has and the denoised one lacks, averaged over small squares. By channel.
Colours details_of(const DenoisedLayer &view);

// For each pixel of views[at], the share of what the denoiser took that is kept: 0 to 1. `details` are those of all views.
// `scale`: perceptive depth times z, pixels times scene units; views show the same surface where perceptive depths differ by
// less than one_surface_px.
Values kept_details(std::span<const DenoisedLayer> views, std::span<const Colours> details, std::size_t at,
                    double scale);

} // namespace sparselens
