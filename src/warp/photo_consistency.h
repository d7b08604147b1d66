// Where rim views show another colour than the centre view by more than noise: mirrors, glass, anything whose colour
// depends on the direction. To average views there would lay several pictures over each other.
//
// Block by block the squared difference of centre and rim views on the surfaces both see is held against how much
// the centre view varies from pixel to pixel, where noise and texture show alike. Noise makes both about as large; a
// reflection that moves against its surface makes the first the larger.
#pragma once

#include "warp/surfaces.h"

#include <optional>

namespace sparselens {

struct PhotoConsistencyOptions {
    double scale = 0; // R F: the CoC is scale * (1 / z - 1 / focus)
    // Where a surface is in focus every direction is meant to be averaged: that is what the lens does. Empty: unknown,
    // no surface counts as in focus.
    std::optional<double> focus = {};
};

// For each pixel of some rows of `data`, whose surfaces are given: whether the views may be averaged.
std::vector<bool> find_photo_consistency(const ReprojectedViews &views,
                                         const PhotoConsistencyOptions &options, const Imath::Box2i &data,
                                         const Surfaces &surfaces);

} // namespace sparselens
