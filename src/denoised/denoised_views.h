// Combines denoised views with the original ones: the warp gets the colours of the denoiser where it removed noise, and
// the colours of the renderer where all views show what it removed: lamps, glints, strands, fine texture.
#pragma once

#include "base/image.h"
#include "deep/packed_view.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct DenoisedPicture {
    std::string name; // for messages
    Image image;      // linear, premultiplied, with the windows of its view
};

// For files that hold both, like those of Cycles: returns the view's colours as the denoised ones, and gives the view
// the colours of the layer `noisy_layer`, whose channels it loses. Throws Error, naming the view, if it lacks the
// layer, has no colours or is deep.
DenoisedPicture part_denoised(PackedView &view, const std::string &noisy_layer);

// Changes the colours of the views, which must be placed, with the centre view first. Layers of light that a denoised
// picture lacks, and coverage, stay as they are. `focal_px` and `scale` are those of ReprojectedViews. Throws Error,
// naming both files, if their windows differ, or if a picture has none of its view's layers; and if a view is deep.
void take_denoised(std::vector<PackedView> &views, std::span<const DenoisedPicture> denoised, double focal_px,
                   double scale);

} // namespace sparselens
