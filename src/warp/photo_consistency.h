// Finds where the colours of rim views differ from the colour of the centre view by more than noise: mirrors, glass,
// anything whose colour depends on the direction. Averaging views there would superimpose several images.
//
// Block by block, the squared difference of the centre and rim views on the surfaces that both see is compared with the
// variation of the centre view from pixel to pixel, which contains both noise and texture. Noise makes both about
// equally large; a reflection that moves relative to its surface makes the difference larger.
#pragma once

#include "kernels/warp_rules.h"
#include "lens/thin_lens.h"
#include "warp/images/patch_comparison.h"
#include "warp/surfaces.h"

#include <optional>

namespace sparselens {

struct PhotoConsistencyOptions {
    // On a surface in focus all directions are averaged, as the lens does. Empty: the focus is unknown, and no surface
    // counts as in focus.
    std::optional<ThinLens> lens = {};
    double scale = 1; // R F, pixels times scene units
    int across = 1;   // pixels, across and down, that become one of the picture
};

// For each pixel of some rows.
struct PhotoConsistency {
    std::vector<bool> averages; // the views may be averaged
    // How clearly views differ by more than noise, also in focus, or as if the image lay at another depth.
    std::vector<Disagreement> differ;
};

// Converts the verdict on a block (kernels/warp_rules.h).
Disagreement disagreement_of(std::uint32_t verdict);

// Tests some rows of `data`, whose surfaces are given.
PhotoConsistency find_photo_consistency(const ReprojectedViews &views, const PhotoConsistencyOptions &options,
                                        const Imath::Box2i &data, const Surfaces &surfaces);

} // namespace sparselens
