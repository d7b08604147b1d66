// Combines denoised views with the original ones: the warp gets the colours of the denoiser where it removed noise, and
// the colours of the renderer where all views show what it removed: lamps, glints, strands, fine texture.
#pragma once

#include "base/grid.h"
#include "base/image.h"
#include "deep/view_samples.h"
#include "finish/window_means.h"
#include "view/view_mapping.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct DenoisedPicture {
    std::string name; // for messages
    Image image;      // linear, premultiplied, with the windows of its view
};

// For files that hold both, like those of Cycles: returns the view's colours as the denoised ones, and gives the view
// the colours of the layer `noisy_layer`, whose channels it loses, as it does the denoiser's guides beside them. Throws
// Error, naming the view, if it lacks the layer, has no colours or is deep.
DenoisedPicture part_denoised(PackedView &view, const std::string &noisy_layer);

// Changes the colours of the views, which must be placed, with the centre view first. Layers of light that a denoised
// picture lacks, and coverage, stay as they are. `focal_px` and `scale` are those of ReprojectedViews. Throws Error,
// naming both files, if their windows differ, if a picture has none of its view's layers or shows what another view
// shows; and if a view is deep.
void take_denoised(std::vector<PackedView> &views, std::span<const DenoisedPicture> denoised, double focal_px,
                   double scale);

// Decides which of the details that a denoiser removed from views are not noise.
//
// The noise of one view is independent of the noise of another. A detail is on a surface, so all views that see the
// surface show it. Let R be the noisy view minus the denoised one, averaged over 3 x 3 pixels, as far as they show one
// surface. Over a window, the mean product of R with another noisy view minus the same denoised one is b^2, the square
// of what the denoiser took too much or too little: also where it errs differently in each view, as on lamps. Half of
// the mean squared difference of R in two views is s^2, the square of the noise. The best share of R to keep is
// b^2 / (b^2 + s^2) (N. Wiener, 1949). A small lamp is one pixel of a window: it is kept as far as the mean of R over
// the views stands out from the noise around (W. James, C. Stein, 1961). That noise is measured by geometric means,
// because lamps of other surfaces are outliers among the differences. Views must agree on the lamp; on a firefly they do
// not.

// One layer of a view, pixel by pixel of `grid`.
struct DenoisedLayer {
    Grid grid;                // EXR coordinates
    std::span<const float> z; // planar depth; 0 or less shows nothing
    ViewMapping mapping;      // to the centre view
    Colours noisy, denoised;  // the same channels
};

// Both versions of a view, averaged over small squares: details smaller than a pixel lie in different pixels of
// different views. Only pixels of one surface are averaged, because a lamp lies before another part of it in each view.
struct AveragedLayer {
    Colours noisy, denoised;
};

AveragedLayer averaged(const DenoisedLayer &view, double scale);

// For each pixel of views[at], the share of the removed details that is kept: 0 to 1. `means` are those of all views.
// `scale`: disparity times z, pixels times scene units. Views show the same surface if their disparities
// differ by less than one_surface_px.
Values kept_details(std::span<const DenoisedLayer> views, std::span<const AveragedLayer> means,
                    std::size_t at, double scale);

} // namespace sparselens
