// Views that were denoised, and as they were before: the warp gets the colours of the denoiser where it took away noise, and those of
// the renderer where all views show what it took away: lamps, glints, strands, fine texture.
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

// For files that hold both, as those of Cycles: takes the colours of the view to be denoised, and returns them; the view gets those
// of the layer, and loses the layer's channels. Throws Error, naming the view, where it lacks the layer, has no colours or is deep.
DenoisedPicture part_denoised(PackedView &view, const std::string &noisy_layer);

// Changes the colours of the views, which are placed, with the centre view first. Layers of light that a denoised picture lacks, and
// coverage, stay as they are. `focal_px` and `scale` are those of ReprojectedViews. Throws Error, naming both files, where their
// windows differ, and where a picture has no layer of its view; and where a view is deep.
void take_denoised(std::vector<PackedView> &views, std::span<const DenoisedPicture> denoised, double focal_px,
                   double scale);

} // namespace sparselens
