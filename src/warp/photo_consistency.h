// Finds where the colours of rim views differ from that of the centre view by more than noise: mirrors, glass, anything
// whose colour depends on the direction. Averaging views there would superimpose several images.
//
// Block by block, the squared difference of the centre and rim views on the surfaces that both see is compared with the
// variation of the centre view from pixel to pixel, which contains both noise and texture. Noise makes both about
// equally large; a reflection that moves relative to its surface makes the difference larger.
#pragma once

#include "lens/thin_lens.h"
#include "warp/surfaces.h"

#include <optional>

namespace sparselens {

struct PhotoConsistencyOptions {
    // On a surface in focus all directions are averaged, as the lens does. Empty: the focus is unknown, and no surface
    // counts as in focus.
    std::optional<ThinLens> lens = {};
};

// For each pixel of some rows of `data`, whose surfaces are given, whether the views may be averaged.
std::vector<bool> find_photo_consistency(const ReprojectedViews &views,
                                         const PhotoConsistencyOptions &options, const Imath::Box2i &data,
                                         const Surfaces &surfaces);

} // namespace sparselens
